// SPDX-License-Identifier: GPL-3.0-or-later
// The shapes of LIGGGHTS' walls and meshes as faces of a container.
#ifndef LMP_PFV_WALL_SHAPES_H
#define LMP_PFV_WALL_SHAPES_H

#include "pfv/container.hpp"
#include "pfv/mesh_walls.hpp"

#include <mpi.h>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// The plane or cylinder of a primitive wall; a plane's normal points along its axis. Throws pfv::InputError, which
/// begins with `what`, for another kind of wall.
pfv::Surface surface_of(class FixWallGran* wall, const std::string& what);

/// The plane that all nodes of a mesh lie on, and its motion as a rigid body: surface, velocity, angular velocity and
/// pivot of a face. Its normal points either way. Throws pfv::InputError, which begins with `what`, for a mesh that
/// is no plane. Collective; the same on all ranks.
pfv::ContainerFace plane_of_mesh(class FixMeshSurface* mesh, MPI_Comm world, const std::string& what);

/// All triangles of a mesh in the order of its file. Collective; the same on all ranks.
std::vector<pfv::Triangle> triangles_of(class FixMeshSurface* mesh, MPI_Comm world);

/// Gives a face the motion of a mesh as a rigid body. Collective; the same on all ranks.
void set_motion_of_mesh(pfv::ContainerFace& face, class FixMeshSurface* mesh, MPI_Comm world);

}  // namespace LAMMPS_NS

#endif
