// SPDX-License-Identifier: Apache-2.0
// `fathom spheres MESH --out TOOL.sph`: builds a sphere tree that contains a mesh, and measures its fit.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addSpheresCommand(CLI::App& app);

} // namespace fathom
