// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/replay_report.h"

#include "apps/binding/open_hand.h"
#include "apps/replay/budgets.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace fathom {

std::string decimal(double x) {
    std::ostringstream text;
    if (std::abs(x) >= 1e4) {
        text << std::fixed << std::setprecision(0) << x;
    } else {
        text << std::setprecision(4) << x;
    }
    return text.str();
}

namespace {

void printPart(const char* name, const Percentiles& p, const char* unit) {
    if (p.p50) {
        std::cout << name << " p50 " << decimal(*p.p50) << " p99 " << decimal(*p.p99) << " max "
                  << decimal(*p.max) << " " << unit << "\n";
    }
}

void printArm(const ReplaySummary::Arm& arm) {
    std::cout << "arm          " << arm.leaves << " leaves on " << arm.links.size() << " links, "
              << arm.joints.size() << " joints; at a limit in " << arm.limitedTicks << " ticks, singular in "
              << arm.singularTicks << ", limits exceeded by " << arm.limitViolation << "\n";
    for (const std::string& line : arm.description) {
        std::cout << "  " << line << "\n";
    }
    printPart("  residual  ", arm.residual, "m");
    for (const auto& link : arm.links) {
        if (link.penetration) {
            std::cout << "  link       " << link.name << ": " << link.leaves << " leaves, "
                      << *link.penetration * 1e6 << " um deep\n";
        }
    }
}

} // namespace

void printSummary(const ReplaySummary& s, const std::filesystem::path& out) {
    std::cout << std::setprecision(4);
    std::cout << "frames       " << s.frames.count << " used, " << s.frames.skipped << " skipped on "
              << s.device << "\n";
    if (s.frames.first) {
        std::cout << "  first set  " << *s.frames.first << " s after program start\n";
    }
    printPart("  passes    ", s.frames.gpuMs, "ms");
    printPart("  latency   ", s.frames.latencyMs, "ms");
    std::cout << "haptic       " << s.haptic.ticks << " ticks, " << s.haptic.stalledTicks << " stalled, "
              << s.haptic.trappedTicks << " trapped, " << s.haptic.escapeTicks << " escaping\n";
    printPart("  step      ", s.haptic.stepMicros, "us");
    printPart("  query     ", s.contact.queryMicros, "us");
    std::cout << "  force      up to " << s.haptic.maxForce << " N, torque up to " << s.haptic.maxTorque
              << " N m, stiffness " << s.haptic.stiffness.value_or(0.0) << " N/m\n"
              << "  penetration ";
    if (s.haptic.maxPenetration) {
        std::cout << *s.haptic.maxPenetration * 1e6 << " um\n";
    } else {
        std::cout << "not audited\n";
    }
    if (s.arm) {
        printArm(*s.arm);
    }
    for (const auto& f : s.fixtures) {
        std::cout << "fixture      " << f.name << " (" << f.role << "): " << f.pointsMean.value_or(0.0)
                  << " points, " << f.spheresMean.value_or(0.0) << " spheres per frame\n";
    }
    for (const std::string& warning : s.warnings) {
        std::cout << "warning      " << warning << "\n";
    }
    std::cout << "digest       " << s.digest << "\nwritten to   " << out.string() << "\n";
}

void printBudgets(const ReplaySummary& summary, const Session& session) {
    const size_t leaves = summary.arm ? summary.arm->leaves : session.tool.leafCount();
    for (const BudgetFigure& f :
         budgetFigures(summary, session.camera->info().depth, session.cycles.facts().kind, leaves)) {
        std::cout << "budget       " << f.what << " " << decimal(f.measured) << " " << f.unit << ", at most "
                  << f.budget << " " << f.unit << (f.note.empty() ? "" : " (" + f.note + ")")
                  << (f.holds() ? ", met\n" : ", MISSED\n");
    }
}

void printRealtime(const RealtimeFigures& f, const ThreadPlacement& placement, const ReplaySummary& s) {
    std::cout << "realtime     " << describe(placement) << (f.stopped ? "; stopped by a signal" : "") << "\n";
    printPart("  woken late", f.wokenLateMicros, "us");
    printPart("  exposed   ", f.exposureMs, "ms before the set was published");
    std::cout << "  ticks     " << s.haptic.late << " of " << s.haptic.ticks
              << " ended over one period late, " << f.periodsMissed << " periods without one\n  frames    "
              << f.framesLost << (f.live ? " lost" : " that a live camera would have lost") << ", "
              << f.framesInPlace << " read where the camera left them; scene too old in " << f.staleTicks
              << " ticks\n";
    if (f.renewals > 0) {
        std::cout << "  device    lost and reopened " << f.renewals << " times\n";
    }
    if (f.recordsLost > 0) {
        std::cout << "  records   " << f.recordsLost << " lost: the writer could not keep up\n";
    }
}

void printDrivenArm(const ReplaySummary::Arm::Driven& driven) {
    std::cout << "real arm     " << driven.description << ": at the end " << driven.lastState << "; ticks";
    for (const auto& [state, ticks] : driven.ticks) {
        std::cout << (&state == &driven.ticks.front().first ? " " : ", ") << ticks << " " << state;
    }
    std::cout << "\n  line      " << driven.damaged << " frames damaged, opened again " << driven.reopened
              << " times, feedback up to " << driven.oldest * 1e3 << " ms old\n";
    printPart("  tip behind", driven.tipLag, "m");
}

void printHand(const LiveHand& hand) {
    const LiveHandFigures f = hand.figures();
    std::cout << "hand         " << hand.description() << ": " << axesOf(hand.preset()) << "\n  samples   "
              << f.samples << ", oldest used " << f.worstAge * 1e3 << " ms; lost " << f.losses << " times, "
              << f.unsent << " wrenches not taken\n";
}

} // namespace fathom
