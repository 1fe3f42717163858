// SPDX-License-Identifier: Apache-2.0
#include "apps/latency/latency_report.h"

#include "engine/types/output_file.h"

#include <array>
#include <iomanip>
#include <nlohmann/json.hpp>

namespace fathom {

namespace {

constexpr double kWholeShare = 0.98; // of the requested time, because the clock starts after the first frame
constexpr size_t kMinSamples = 20;   // memory samples: two in each tenth of the run
constexpr std::array<size_t, 14> kSteps{0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

void printTimes(std::ostream& out, const char* name, const Histogram& h) {
    out << name << " p50 " << h.percentile(0.5) << " p99 " << h.percentile(0.99) << " p99.9 "
        << h.percentile(0.999) << " max " << h.max() << " us";
}

nlohmann::json toJson(const Histogram& h) {
    nlohmann::json bins = nlohmann::json::array(); // [us, count]
    for (size_t i = 0; i < h.bins().size(); ++i) {
        if (h.bins()[i] > 0) {
            bins.push_back({i, h.bins()[i]});
        }
    }
    return {{"count", h.count()},
            {"mean_us", h.mean()},
            {"p50_us", h.percentile(0.5)},
            {"p99_us", h.percentile(0.99)},
            {"p999_us", h.percentile(0.999)},
            {"max_us", h.max()},
            {"bins", bins}};
}

} // namespace

void printLatency(std::ostream& out, const LatencyPart& part) {
    out << std::fixed << std::setprecision(1) << std::left << std::setw(13) << part.load;
    printTimes(out, "woken late", part.late);
    printTimes(out, "; step", part.tick);
    out << "\n             " << part.tick.count() << " ticks in " << part.seconds << " s, "
        << part.periodsMissed << " periods without one, " << part.late.between(1000, Histogram::kBins)
        << " over 1 ms late, " << part.framesLost << " frames lost";
    if (!part.memory.empty()) {
        out << "; memory " << part.memory.back() << " MiB, grown by " << part.memoryGrowth();
    }
    out << "\n";
}

void printHistograms(std::ostream& out, std::span<const LatencyPart> parts) {
    std::vector<const Histogram*> columns;
    out << std::right << std::setw(14) << "from us";
    for (const LatencyPart& part : parts) {
        out << std::setw(14) << part.load + " late" << std::setw(14) << part.load + " step";
        columns.insert(columns.end(), {&part.late, &part.tick});
    }
    out << "\n";
    bool begun = false;
    for (size_t i = 0; i < kSteps.size(); ++i) {
        const size_t to = i + 1 < kSteps.size() ? kSteps[i + 1] : Histogram::kBins;
        uint64_t row = 0, beyond = 0;
        for (const Histogram* h : columns) {
            row += h->between(kSteps[i], to);
            beyond += h->between(kSteps[i], Histogram::kBins);
        }
        begun = begun || row > 0;
        if (!begun || beyond == 0) {
            continue;
        }
        out << std::setw(14) << kSteps[i];
        for (const Histogram* h : columns) {
            out << std::setw(14) << h->between(kSteps[i], to);
        }
        out << "\n";
    }
}

void writeLatency(const std::filesystem::path& file, std::span<const LatencyPart> parts, double rateHz,
                  const std::string& device, bool endedBySignal) {
    nlohmann::json all = {{"rate_hz", rateHz},
                          {"device", device},
                          {"ended_by_signal", endedBySignal},
                          {"parts", nlohmann::json::array()}};
    for (const LatencyPart& part : parts) {
        all["parts"].push_back({{"load", part.load},
                                {"seconds", part.seconds},
                                {"woken_late", toJson(part.late)},
                                {"turn", toJson(part.tick)},
                                {"frames_lost", part.framesLost},
                                {"periods_missed", part.periodsMissed},
                                {"records_lost", part.recordsLost},
                                {"arm_travel", part.armTravel},
                                {"memory_MiB", part.memory},
                                {"memory_growth_MiB", part.memoryGrowth()}});
    }
    OutputFile out(file);
    out.write(all.dump(1) + "\n");
    out.commit();
}

bool soakHolds(const LatencyPart& part, double required) {
    const bool whole = part.seconds >= kWholeShare * required && part.frames > 0 && part.tick.count() > 0 &&
                       part.memory.size() >= kMinSamples;
    return whole && part.framesLost == 0 && part.recordsLost == 0 && part.memoryGrowth() <= kMaxGrowth;
}

} // namespace fathom
