// SPDX-License-Identifier: Apache-2.0
// `fathom inspect SOURCE`: what a recording or camera contains, and which streams Fathom uses.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addInspectCommand(CLI::App& app);

} // namespace fathom
