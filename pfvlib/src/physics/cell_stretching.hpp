// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "network/spheres.hpp"
#include "pfv/container.hpp"
#include "pfv/network.hpp"
#include "physics/force_matrix.hpp"
#include "physics/throats.hpp"
#include "physics/volume_rates.hpp"

namespace pfv {

// A periodic cell that changes its lengths: its two faces along an axis move apart at dL/dt, and with them the
// images, which stand n L away from their spheres and move by n dL/dt beside them. What is here gives the
// columns of these faces in S^T and E their meaning, so that v_lo and v_hi of the cell bring that motion in.

/// Whether the cell is periodic and changes one of its lengths.
bool stretches(const Container& container);

/// Adds the rows of the periodic faces to S: v_hi - v_lo times (image offset / L) times the part of each facet
/// that the image drags. A facet that leads to the image of a pore is moved by L less in that pore's frame, so
/// that over all pores S^T v adds up to the rate of the cell's volume: the facets that part the cell from its
/// images carry sum A (x) offset = V I. A wall beside such an axis stretches evenly with it. The row is also the
/// transpose: the force of the fluid's stress on that face, area p for a pressure p everywhere.
/// `grains`: the spheres in the cell that `vertices` are images of.
void add_stretching(ForceMatrix& matrix, const PoreNetwork& network, const Spheres& grains,
                    const Spheres& vertices, const Throats& throats, const ViscousShares& shares);

/// The same for E = dV/dx.
void add_stretching(VolumeRateMatrix& matrix, const PoreNetwork& network, const Spheres& grains,
                    const Spheres& vertices);

}  // namespace pfv
