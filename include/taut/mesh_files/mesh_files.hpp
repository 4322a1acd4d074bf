// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Meshes and their motion as files: OBJ, PLY, PC2, VTK.

#include "mesh_sequence.hpp"
#include "obj.hpp"
#include "pc2.hpp"
#include "ply.hpp"
#include "vtk.hpp"
#include "weld.hpp"
