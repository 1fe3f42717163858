// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/proxy.h"

#include "engine/haptics/constrained_proxy_rows.h"

namespace fathom {

template class ConstrainedProxy<ToolKinematics>;

Proxy::Proxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options, const Pose& start)
    : ConstrainedProxy(tool, shapes, options, ToolKinematics(tool, options, start)) {}

ProxyStep Proxy::step(const ProxyInput& input) noexcept {
    ProxyStep out;
    if (begin(input)) {
        finish(input, out);
    } else { // no set that fits the tool: it waits, without a force
        out.cut = true;
        out.allowed = input.target;
    }
    report(out);
    return out;
}

} // namespace fathom
