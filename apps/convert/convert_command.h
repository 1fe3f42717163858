// SPDX-License-Identifier: Apache-2.0
// `fathom convert SOURCE --out DIR`: a recording in another format.
#pragma once

namespace CLI {
class App;
}

namespace fathom {

void addConvertCommand(CLI::App& app);

} // namespace fathom
