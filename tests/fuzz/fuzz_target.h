// SPDX-License-Identifier: Apache-2.0
// What reads bytes of strangers, each as a function of bytes. A target may throw Error with one line of text
// (that is how input is refused); anything else that comes out of it is a finding, and so is what a sanitizer
// says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace fathom::testing {

using Bytes = std::span<const uint8_t>;

struct FuzzTarget {
    const char* name; // also of its folder below tests/fuzz/corpus
    void (*read)(Bytes input);
    long dear = 1; // how many runs of another target one of this costs
};

// All there are, in order of name.
std::span<const FuzzTarget> fuzzTargets();

// Runs one input through a target. Ends the process with a message when something other than a one-line Error
// comes out. True when the input was taken, false when it was refused.
bool runFuzzTarget(const FuzzTarget& target, Bytes input);

// A file with these bytes in a folder of this process alone, in memory where that can be had; the next one of
// the same name replaces it.
std::filesystem::path fuzzFile(const std::string& name, Bytes content);

// Ends the process when what a reader promises does not hold.
void need(bool holds);

void readScene(Bytes input);
void readIndexFile(Bytes input);
void readIntrinsicsFile(Bytes input);
void readTracks(Bytes input);
void readPng(Bytes input);
void readJpegImage(Bytes input);
void readPcdFile(Bytes input);
void readBag(Bytes input);
void readSphFile(Bytes input);
void readSpheresYaml(Bytes input);
void readUrdfFile(Bytes input);
void readMesh(Bytes input);
void readDescriptors(Bytes input);
void readPixels(Bytes input);
void readFalcon(Bytes input);
void readSpaceMouse(Bytes input);
void readReach(Bytes input);
void readEca(Bytes input);
void readEndpoint(Bytes input);
void readHaply(Bytes input);
void readTurns(Bytes input);
void readPairs(Bytes input);
void readFirmware(Bytes input);

} // namespace fathom::testing
