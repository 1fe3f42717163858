// SPDX-License-Identifier: Apache-2.0
// A temporary folder with a recording, a scene and a hand path. Each replay of it is checked against the
// contract of `replay --out`.
#pragma once

#include "tests/rig/replay_output.h"
#include "tests/rig/run_fathom.h"
#include "tests/rig/small_recording.h"

namespace fathom {

// The files of a finished replay.
struct Replay {
    std::filesystem::path out;
    ProgramRun run;
    nlohmann::json summary;
    std::vector<Tick> ticks;
    std::vector<FrameRow> frames;
    std::vector<std::string> timeColumns; // columns of pass times in frames.csv

    const nlohmann::json& haptic() const { return summary.at("haptic"); }
    // The frame's saved set; an empty path = none.
    std::filesystem::path ply(int frame) const;
    const Tick& at(double t) const; // the first tick at or after t [s]
};

// Expected values for checkContract.
struct Terms {
    double rate = 1000.0;                         // [Hz]
    double forceLimit = 20.0, torqueLimit = 2.0;  // [N], [N m]
    bool calm = true;                             // no force before the first contact, stall or guidance
    double slewForce = 2000.0, slewTorque = 50.0; // [N/s], [N m/s]
    std::string empty;   // the class that gets no region or target, which is warned about; else no warning
    std::string warning; // beginning of the only warning, if it is another one
};

// Reads a finished replay and checks files, keys, columns, counts, times and invariants.
Replay readReplay(const std::filesystem::path& out, const ProgramRun& run);
void checkContract(const Replay& replay, const Terms& terms);

class Stage {
public:
    Stage();
    const std::filesystem::path& path() const { return folder_.path(); }
    std::filesystem::path operator/(const std::string& name) const { return folder_.path() / name; }

    void recording(const std::vector<Image>& images) const { writeRecording(*this / "rec", images); }
    void scene(const SceneText& scene) const { folder_.write("scene.yaml", scene.text()); }
    void hand(const std::vector<HandRow>& rows) const { folder_.write("hand.csv", handCsv(rows)); }
    void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
    std::string read(const std::string& name) const { return folder_.read(name); }

    // Command line of a replay of scene.yaml, with rec and hand.csv if they exist.
    std::vector<std::string> command(const std::vector<std::string>& more = {},
                                     const std::string& out = "out") const;
    // Runs it, requires exit code 0 and an empty standard error, and checks the contract.
    Replay replay(const std::vector<std::string>& more = {}, const Terms& terms = {},
                  const std::string& out = "out") const;

private:
    TemporaryFolder folder_;
};

} // namespace fathom
