// SPDX-License-Identifier: GPL-3.0-or-later
// libliggghts-dev lacks this generated list of contact models; only their numbers would stand here.
