// SPDX-License-Identifier: Apache-2.0
// `fathom spheres MESH --out TOOL.sph`: from a mesh to a sphere tree that contains it, and how well.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addSpheresCommand(CLI::App& app);

} // namespace fathom
