# SPDX-License-Identifier: GPL-3.0-or-later
# The lid is no wall of the grains: it closes the water off behind the upper plate and goes up and down with it.
variable behind equal $(bound(all,zmax))+1.001*${r2}
variable under  equal $(bound(all,zmin))-1.001*${r2}
fix lid all mesh/surface/stress file ${lid} type 4 move 0. 0. ${behind}
fix lift all move/mesh mesh lid linear/variable v_zero v_zero v_vz
