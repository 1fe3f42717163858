// SPDX-License-Identifier: Apache-2.0
// Traces as one range per pixel column.
#include "apps/operate/trace_columns.h"
#include "apps/operate/trace_plot.h"

#include <doctest/doctest.h>
#include <map>

using namespace fathom;
using namespace fathom::operate;

namespace {

// Ten seconds of a force along x: a spike of one tick, then a step.
struct SpikedTrace {
    static constexpr double kSpike = 4.321; // [s]
    std::deque<TraceSample> trace;
    TraceColumns kept;
    std::map<int, std::pair<float, float>> columns;
    int strokes = 0;

    SpikedTrace() {
        for (int i = 0; i < 10000; ++i) {
            TraceSample sample;
            sample.t = 0.001 * i;
            sample.residual.force.x = std::numeric_limits<float>::quiet_NaN();
            sample.whole.force.x = i == 4321 ? 9.0f : i < 5000 ? 1.0f : 2.0f;
            trace.push_back(sample);
        }
    }
    // Shows samples [from, to).
    void follow(int from, int to, uint64_t restarts, int count) {
        kept.follow({trace.begin() + from, trace.begin() + to}, restarts, count);
        columns.clear();
        strokes = 0;
        kept.each(TraceColumns::X, [this](int first, int last, float low, float high) {
            ++strokes;
            for (int column = first; column <= last; ++column) {
                CHECK(columns.count(column) == 0);
                columns[column] = {low, high};
            }
        });
    }
};

} // namespace

TEST_CASE("Each column of a trace covers the range of its samples and joins its neighbours") {
    SpikedTrace trace;
    for (int end = 0; end <= 10000; end += 50) { // as window frames add samples
        trace.follow(0, end, 0, 640);
    }
    CHECK(trace.columns.size() == 640);
    CHECK(trace.strokes == 5); // before, at and after the spike; at the step; after it
    CHECK(trace.columns.at(static_cast<int>(trace.kSpike * 64.0)) == std::pair(1.0f, 9.0f));
    CHECK(trace.columns.at(static_cast<int>(4.9 * 64.0)) == std::pair(1.0f, 1.0f));
    CHECK(trace.columns.at(320) == std::pair(1.0f, 2.0f)); // the step, between its last sample and the next
    CHECK(trace.columns.at(321) == std::pair(2.0f, 2.0f));
    int unknown = 0;
    trace.kept.each(TraceColumns::Residual, [&](int, int, float, float) { ++unknown; });
    CHECK(unknown == 0);
}

TEST_CASE("The columns of a trace begin anew at an earlier time, in another run and at another width") {
    SpikedTrace trace;
    const int spike = static_cast<int>(trace.kSpike * 64.0);
    trace.follow(0, 10000, 0, 640);
    trace.follow(0, 9000, 0, 640); // earlier; the newest column is the last one
    CHECK(trace.columns.size() == 576);
    CHECK(trace.columns.at(spike + 64) == std::pair(1.0f, 9.0f));
    trace.follow(8000, 10000, 1, 640); // another run
    CHECK(trace.columns.size() == 128);
    CHECK(trace.strokes == 1);
    trace.follow(0, 10000, 1, 320);
    CHECK(trace.columns.size() == 320);
    CHECK(trace.columns.at(spike / 2) == std::pair(1.0f, 9.0f));
    trace.follow(0, 2000, 2, 320);
    trace.follow(8000, 10000, 2, 320); // what is between them was never seen
    CHECK(trace.columns.size() == 64);
    trace.follow(0, 0, 2, 320);
    CHECK(trace.columns.empty());
}

TEST_CASE("A state that flickers is one bar, and one that comes back after 0.1 s is another") {
    std::deque<TraceSample> trace;
    for (int i = 0; i < 100; ++i) {
        TraceSample sample;
        sample.t = 0.01 * i;
        const bool busy = i >= 10 && i < 40, again = i >= 60 && i < 70;
        sample.state = busy && i % 2 == 0   ? StepState::Escape
                       : busy && i % 3 == 0 ? StepState::Waiting
                       : again              ? StepState::Escape
                                            : StepState::Contact;
        trace.push_back(sample);
    }
    const std::vector<TraceSpan> spans = traceSpans(trace);
    REQUIRE(spans.size() == 3);
    CHECK(std::string(spans[0].word) == "escape");
    CHECK(spans[0].from == doctest::Approx(0.1));
    CHECK(spans[0].to == doctest::Approx(0.39));
    CHECK(std::string(spans[1].word) == "lags");
    CHECK(spans[1].from == doctest::Approx(0.15));
    CHECK(spans[1].to == doctest::Approx(0.4));
    CHECK(std::string(spans[2].word) == "escape");
    CHECK(spans[2].from == doctest::Approx(0.6));
}

TEST_CASE("A state that lasts is one bar from its begin to its end, however often it comes back") {
    std::deque<TraceSample> trace;
    for (int i = 0; i < 100; ++i) {
        TraceSample sample;
        sample.t = 0.01 * i;
        const bool fades = (i >= 20 && i < 50) || i >= 60;
        sample.state = fades ? StepState::Fading : StepState::Contact;
        sample.fade = i < 80 ? FadeReason::OldFrame : FadeReason::RegionGone;
        sample.guided = i >= 10 && i < 30;
        trace.push_back(sample);
    }
    const std::vector<TraceSpan> spans = traceSpans(trace);
    REQUIRE(spans.size() == 4);
    CHECK(std::string(spans[0].word) == "guide");
    CHECK(spans[0].from == doctest::Approx(0.1));
    CHECK(spans[0].to == doctest::Approx(0.3));
    CHECK(std::string(spans[1].word) == "old frame");
    CHECK(spans[1].from == doctest::Approx(0.2));
    CHECK(spans[1].to == doctest::Approx(0.5));
    CHECK(spans[2].to == doctest::Approx(0.8)); // another cause
    CHECK(std::string(spans[3].word) == "region gone");
    CHECK(spans[3].to == doctest::Approx(0.99)); // it lasts
}
