// SPDX-License-Identifier: Apache-2.0
// `fathom inspect SOURCE`: what a recording or camera holds, and what Fathom takes of it.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addInspectCommand(CLI::App& app);

} // namespace fathom
