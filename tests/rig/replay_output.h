// SPDX-License-Identifier: Apache-2.0
// Readers for the files of `replay --out`. They share no code with the program.
#pragma once

#include "engine/types/pose.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fathom {

struct Tick { // a row of haptics.csv
    double t;
    Pose device, tool;
    dvec3 force, torque;
    uint32_t contacts;
    double minGap;
    std::string state;
    double guidance;
    int frame;
    double sceneAge;
    uint32_t stalled;
    double marginPassive, marginUncoupled;
    uint32_t cause; // bits of wrench_stage.h
    double lag;     // [m]
    dvec3 outForce, outTorque, restForce,
        restTorque;   // delivered, in device axes; not delivered, in base axes
    double clearance; // [m]
};

struct FrameRow { // a row of frames.csv
    uint32_t index;
    double t;
    uint64_t valid, forbidden, spheres, patches, nodes, guidance;
    std::map<std::string, double> times; // upload_ms, <pass>_ms.., publish_ms, answerable_ms
};

struct SavedSphere { // a vertex of fixtures/NNNNNN.ply
    dvec3 centre;
    double radius;
    int fixture, held;
};

// A PNG file. Pixels: 0xAABBGGRR, row by row.
struct ReadImage {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels;
};

// Each throws std::runtime_error with file and place when the file violates the contract.
std::vector<Tick> readTicks(const std::filesystem::path& file);
std::vector<FrameRow> readFrames(const std::filesystem::path& file,
                                 std::vector<std::string>* timeColumns = nullptr);
std::vector<SavedSphere> readPly(const std::filesystem::path& file);
ReadImage readImage(const std::filesystem::path& file);
std::string readWhole(const std::filesystem::path& file);

} // namespace fathom
