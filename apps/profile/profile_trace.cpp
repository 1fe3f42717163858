// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/profile_trace.h"

#include "apps/profile/frame_sequence.h"
#include "engine/cycle/cadence_trace.h"
#include "engine/cycle/contact_cycle.h"
#include "engine/haptics/proxy.h"

namespace fathom::profile {

namespace {

constexpr int kTicks = 33; // per frame: 1 kHz against 30 Hz

void traceTicks(ContactCycle& contact, const FrameBench& bench, Proxy& proxy, const Pose& touching,
                CadenceTrace& trace, int frame) {
    ContactSet set;
    for (int k = 0; k < kTicks; ++k) {
        const TraceTime begin = std::chrono::steady_clock::now();
        contact.query(bench.set(), proxy.pose(), set);
        const TraceTime answered = std::chrono::steady_clock::now();
        trace.query(begin, answered, set.size());
        const double phase = 0.02 * (frame * kTicks + k);
        Pose hand = touching;
        hand.position += dvec3(0.02 * std::sin(phase), 0.02 * std::cos(phase), 0.003);
        proxy.step({hand, 0.05, &set, {}});
        trace.step(answered, std::chrono::steady_clock::now(), 0.0);
    }
}

} // namespace

void writeTimeLine(const StudyContext& context, const std::filesystem::path& file) {
    const FrameSequence source = studySources(context.settings, {"tank"}, 4).front();
    const Tool tool = ballTool(64);
    FrameBench bench(context.device, studyScene(context.settings), source.camera, {}, 64);
    CadenceTrace trace(file, bench.cycle().passNames());
    bench.run(source.frames.front());
    if (bench.set().host.spheres.size() == 0) {
        trace.file().finish(); // nothing to touch: the trace has only frames
        return;
    }
    const Pose touching = touchingPose(tool, bench.set().host, source.frames.front().baseTcamera);
    ContactCycle contact(bench.queryContext(), tool, 0.01);
    Proxy proxy(tool, {}, {}, touching);
    for (int frame = 0; frame < (context.settings.quick ? 10 : 60); ++frame) {
        trace.frame(bench.run(source.frames[static_cast<size_t>(frame) % source.frames.size()]));
        traceTicks(contact, bench, proxy, touching, trace, frame);
        trace.file().drain();
    }
    trace.file().finish();
}

} // namespace fathom::profile
