// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/query_crossings.h"

#include "apps/profile/frame_sequence.h"
#include "engine/scene/plan.h"
#include "engine/types/joined.h"

#include <algorithm>
#include <set>

namespace fathom::profile {

namespace {

// p50 [ms] of all methods with one tool in one set; NaN = not measured.
struct Measured {
    std::string source;
    double spheres = NAN, leaves = NAN;
    double cpuSet = NAN, gpuSet = NAN;                  // full contact set
    double gridCull = NAN, treeCull = NAN, brute = NAN; // the cull alone
};
using MeasuredValue = double Measured::*;

std::vector<Measured> measuredOf(const std::vector<StudyRow>& rows) {
    std::vector<Measured> all;
    for (const StudyRow& row : rows) {
        const bool cpu = isMethod(row, kCpuMethod), gpu = isMethod(row, kGpuMethod);
        if (!cpu && !gpu && !isMethod(row, kBruteMethod)) {
            continue;
        }
        auto at = std::find_if(all.begin(), all.end(), [&](const Measured& m) {
            return m.source == row.source && m.leaves == row.more[kToolLeaves];
        });
        if (at == all.end()) {
            at = all.insert(all.end(), {row.source, row.more[kRegionSpheres], row.more[kToolLeaves]});
        }
        (cpu ? at->gridCull : gpu ? at->treeCull : at->brute) = cullTime(row);
        if ((cpu || gpu) && row.cost.submit) {
            (cpu ? at->cpuSet : at->gpuSet) = row.cost.submit.p50;
        }
    }
    return all;
}

// Pairs of the entries that `wanted` accepts and that both methods measured.
template <class Wanted, class Size>
std::vector<TimePair> pairsOf(const std::vector<Measured>& all, MeasuredValue first, MeasuredValue second,
                              Wanted&& wanted, Size&& size) {
    std::vector<TimePair> pairs;
    for (const Measured& m : all) {
        if (wanted(m) && std::isfinite(m.*first) && std::isfinite(m.*second)) {
            pairs.push_back({size(m), m.*first, m.*second});
        }
    }
    return pairs;
}

std::string countOf(double value) {
    return value < 1e4   ? digits(value, 4)
           : value < 1e6 ? digits(value * 1e-3, 4) + " k"
                         : digits(value * 1e-6, 4) + " M";
}

std::string listOf(const std::vector<double>& values) {
    return joined(values, countOf);
}

double largestSize(const std::vector<TimePair>& pairs) {
    double most = 0.0;
    for (const TimePair& p : pairs) {
        most = std::max(most, p.size);
    }
    return most;
}

// Text such as "from 60 k spheres on, and at 1000" or "never here (up to 1.024 M spheres), but at 1000".
std::string fromWhere(const std::vector<TimePair>& pairs, const std::string& unit) {
    const Crossing crossing = crossingOf(pairs);
    const bool never = std::isinf(crossing.from);
    std::string text = never ? "never here (up to " + countOf(largestSize(pairs)) + " " + unit + ")"
                             : "from " + countOf(crossing.from) + " " + unit + " on";
    if (!crossing.before.empty()) {
        text += (never ? ", but at " : ", and at ") + listOf(crossing.before);
    }
    return text;
}

std::vector<TimePair> pairsByLeaves(const std::vector<Measured>& all, const std::string& source) {
    return pairsOf(
        all, &Measured::cpuSet, &Measured::gpuSet, [&](const Measured& m) { return m.source == source; },
        [](const Measured& m) { return m.leaves; });
}

std::vector<TimePair> pairsBySpheres(const std::vector<Measured>& all, double leaves) {
    return pairsOf(
        all, &Measured::cpuSet, &Measured::gpuSet, [&](const Measured& m) { return m.leaves == leaves; },
        [](const Measured& m) { return m.spheres; });
}

std::vector<TimePair> pairsByWork(const std::vector<Measured>& all, MeasuredValue second) {
    return pairsOf(
        all, &Measured::brute, second, [](const Measured&) { return true; },
        [](const Measured& m) { return m.spheres * m.leaves; });
}

std::vector<std::string> sourcesIn(const std::vector<Measured>& all) {
    std::vector<std::string> names;
    for (const Measured& m : all) {
        if (std::isfinite(m.gpuSet) && (names.empty() || names.back() != m.source)) {
            names.push_back(m.source);
        }
    }
    return names;
}

std::set<double> toolsIn(const std::vector<Measured>& all) {
    std::set<double> leaves;
    for (const Measured& m : all) {
        if (std::isfinite(m.gpuSet)) {
            leaves.insert(m.leaves);
        }
    }
    return leaves;
}

} // namespace

Crossing crossingOf(const std::vector<TimePair>& pairs) {
    double lastSlower = -1.0;
    std::set<double> slower;
    for (const TimePair& p : pairs) {
        if (!(p.second < p.first)) {
            slower.insert(p.size);
            lastSlower = std::max(lastSlower, p.size);
        }
    }
    Crossing crossing;
    std::set<double> before;
    for (const TimePair& p : pairs) {
        if (p.size > lastSlower) {
            crossing.from = std::min(crossing.from, p.size);
        } else if (slower.count(p.size) == 0) {
            before.insert(p.size);
        }
    }
    crossing.before.assign(before.begin(), before.end());
    return crossing;
}

uint32_t leavesForTheDevice(const std::vector<StudyRow>& rows) {
    const std::vector<Measured> all = measuredOf(rows);
    double most = 0.0;
    for (const std::string& source : sourcesIn(all)) {
        most = std::max(most, crossingOf(pairsByLeaves(all, source)).from);
    }
    return most > 0.0 && std::isfinite(most) ? static_cast<uint32_t>(most) : kNeverOnGpu;
}

std::vector<std::string> crossingFindings(const std::vector<StudyRow>& rows) {
    const std::vector<Measured> all = measuredOf(rows);
    std::vector<std::string> findings;
    for (const std::string& source : sourcesIn(all)) {
        findings.push_back("contact set in " + source + ", device faster than CPU: " +
                           fromWhere(pairsByLeaves(all, source), "tool leaves"));
    }
    for (const double leaves : toolsIn(all)) {
        findings.push_back("contact set with " + countOf(leaves) + " leaves, device faster than CPU: " +
                           fromWhere(pairsBySpheres(all, leaves), "region spheres"));
    }
    for (const auto& [name, cull] : {std::pair{"the CPU's grid", &Measured::gridCull},
                                     std::pair{"the device's tree", &Measured::treeCull}}) {
        findings.push_back(std::string("cull alone, ") + name + " faster than brute force: " +
                           fromWhere(pairsByWork(all, cull), "spheres x leaves"));
    }
    return findings;
}

std::string autoDecision(const DeviceFacts& device, const std::vector<uint32_t>& toolLeaves) {
    Scene scene = everyPointScene();
    scene.contact.where = Scene::Contact::Where::Auto;
    const CameraInfo camera = wallFrame(64, 48, 1.0).camera;
    std::vector<double> deviceLeaves;
    for (const uint32_t leaves : toolLeaves) {
        if (makePlan(scene, camera, leaves, device).query == Plan::Query::Gpu) {
            deviceLeaves.push_back(leaves);
        }
    }
    const std::string who =
        deviceLeaves.empty() ? "the CPU with every tool measured"
        : deviceLeaves.size() == toolLeaves.size()
            ? "the device with every tool measured"
            : "the device with tools of " + listOf(deviceLeaves) + " leaves, the CPU with the others";
    const std::string why = device.kind == DeviceKind::Cpu ? "this device is a CPU, which it never asks"
                            : device.gpuQueryLeaves == kNeverOnGpu
                                ? "no tool is known for which the device is faster in every set measured"
                                : "the device is faster in every set measured from " +
                                      countOf(device.gpuQueryLeaves) + " leaves on";
    return "'where: auto' decides before the first frame, by the tool's leaves and the worst set; it asks " +
           who + ": " + why + "; it never uses brute force";
}

} // namespace fathom::profile
