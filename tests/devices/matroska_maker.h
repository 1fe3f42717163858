// SPDX-License-Identifier: Apache-2.0
// Makes Matroska files as k4arecorder lays them out, by the format's pages (RFC 8794 and RFC 9559).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::testing {

// An element. The size takes 8 bytes; without a size the element is endless.
std::string ebml(uint32_t id, const std::string& data, bool sized = true);
std::string ebmlNumberElement(uint32_t id, uint64_t value);

struct MkvTrack {
    uint64_t number = 1;
    std::string name;
    uint32_t width = 0, height = 0;
    std::string fourcc; // as V_MS/VFW/FOURCC
    uint64_t uid = 0;
    std::string more; // further elements of the track
};
struct MkvBlock {
    uint64_t track = 1, time = 0; // [us]
    std::string data;
};

// A file with one cluster per block. Blocks of even places are SimpleBlocks, others Blocks in a BlockGroup.
struct MkvFile {
    std::vector<MkvTrack> tracks;
    std::vector<std::pair<std::string, std::string>> tags;
    std::string calibration; // attached as calibration.json; empty = none
    std::vector<MkvBlock> blocks;
    bool sized = true; // of segment and clusters

    std::string bytes() const;
    std::string cluster(size_t block) const;
};

// calibration.json of an Azure Kinect: these lenses (cx cy fx fy k1 to k6, centre, p2 p1), and colour's pose.
struct KinectLenses {
    std::string depth = "[0.5,0.5,0.5,0.5,0,0,0,0,0,0,0,0,0,0,1.7]";
    std::string colour = "[0.5,0.5,0.5,0.625,0,0,0,0,0,0,0,0,0,0,1.7]";
    std::string model = "CALIBRATION_LensDistortionModelBrownConrady";
    std::string rotation = "[1,0,0,0,1,0,0,0,1]", translation = "[-0.032,-0.002,0.004]";
    std::string colourSize = R"("SensorWidth":4096,"SensorHeight":3072)";
};
std::string kinectCalibration(const KinectLenses& lenses = {});

} // namespace fathom::testing
