// SPDX-License-Identifier: Apache-2.0
// The readers of untrusted input, each as a function of bytes. A target may throw Error with one line of
// text, which rejects the input. Any other exception or a sanitizer report is a finding.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace fathom {
class Camera;
}

namespace fathom::testing {

using Bytes = std::span<const uint8_t>;

struct FuzzTarget {
    const char* name; // also the name of its folder below tests/fuzz/corpus
    void (*read)(Bytes input);
    long dear = 1; // cost of one run, relative to other targets
};

// All targets, sorted by name.
std::span<const FuzzTarget> fuzzTargets();

// Runs a target on an input. Ends the process with a message on anything other than a one-line Error.
// True when the input was accepted, false when it was rejected.
bool runFuzzTarget(const FuzzTarget& target, Bytes input);

// Writes a file with these bytes to a folder of this process, in memory if possible. A later file of the same
// name replaces it.
std::filesystem::path fuzzFile(const std::string& name, Bytes content);

// Ends the process when a guarantee of a reader is violated.
void need(bool holds);

// Plays a camera's first frames and checks what it promises.
void drain(Camera& camera);

void readScene(Bytes input);
void readIndexFile(Bytes input);
void readIntrinsicsFile(Bytes input);
void readTracks(Bytes input);
void readPng(Bytes input);
void readDepthFile(Bytes input);
void readJpegImage(Bytes input);
void readPcdFile(Bytes input);
void readPlyFile(Bytes input);
void readBag(Bytes input);
void readMcap(Bytes input);
void readDatabase(Bytes input);
void readMatroska(Bytes input);
void readKinectCalibration(Bytes input);
void readSdkMessages(Bytes input);
void readMessage(Bytes input);
void readMessageImage(Bytes input);
void readSourceText(Bytes input);
void readSphFile(Bytes input);
void readSpheresYaml(Bytes input);
void readUrdfFile(Bytes input);
void readUrdfPacket(Bytes input);
void readMesh(Bytes input);
void readDescriptors(Bytes input);
void readPixels(Bytes input);
void readFalcon(Bytes input);
void readSpaceMouse(Bytes input);
void readReach(Bytes input);
void readEca(Bytes input);
void readEndpoint(Bytes input);
void readHaply(Bytes input);
void readRos2Hand(Bytes input);
void readTicks(Bytes input);
void readPairs(Bytes input);
void readFirmware(Bytes input);

} // namespace fathom::testing
