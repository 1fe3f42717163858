// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/window_latency.h"

#include "apps/operate/operator_run.h"

#include <cstdlib>

namespace fathom::operate {

LatencyPart measureWindow(const LatencyOptions& options, const GlobalOptions& global) {
    OperateOptions o;
    o.scene = options.scene;
    o.source = options.source;
    o.path = true;
    o.runTime = options.seconds; // not wall time: the window may wait long for its first frame
    o.armed = true;              // as in the other loads
    o.offscreen = std::getenv("DISPLAY") == nullptr ? "1280x720" : "";
    OperatorRun run(o, global);
    run.run();
    const RunView& seen = run.view();
    LatencyPart part;
    part.load = "window";
    for (size_t i = 0; i < seen.stepMicros().size(); ++i) {
        part.tick.add(static_cast<double>(seen.stepMicros()[i]));
        part.late.add(static_cast<double>(seen.wokenLateMicros()[i]));
    }
    part.seconds = seen.step().record.t;
    part.take(run.engine());
    return part;
}

} // namespace fathom::operate
