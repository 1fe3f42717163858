// SPDX-License-Identifier: Apache-2.0
// Recording folders made for a test, and the real ones next to the repository.
#pragma once

#include "devices/recorded/source_options.h"
#include "tests/support/scratch_folder.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// Where the real recordings are, seen from the repository root.
inline const std::filesystem::path kRecordings = "../shared/data";

// False, with a message, when the recording is missing.
bool haveRecording(const std::string& name);

using TemporaryFolder = testing::ScratchFolder;

// PNG of rows of raw bytes as libpng takes them (16-bit values big-endian). colourType: 0 grey, 2 RGB, 3
// palette, 4 grey + alpha, 6 RGBA. A palette has the three colours red, green, blue.
void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height, int bits, int colourType,
              const std::vector<uint8_t>& bytes, bool interlaced = false);

// width x height, every depth pixel `value`.
void writeDepth(const std::filesystem::path& file, uint32_t width, uint32_t height, uint16_t value);
// Every pixel r, g, b.
void writeColour(const std::filesystem::path& file, uint32_t width, uint32_t height, uint8_t r, uint8_t g,
                 uint8_t b);

// A valid recording of `frames` pairs of 7 x 5 images: depth 1000 + i, colour (i, 20, 30), stamps i / 10 s.
inline constexpr uint32_t kSmallWidth = 7, kSmallHeight = 5;
extern const std::string kSmallIntrinsics;
void writeSmallRecording(const TemporaryFolder& folder, uint32_t frames);

// Adds 7 x 5 images: depth of one value, and one colour.
void addPair(const TemporaryFolder& folder, const std::string& depth, const std::string& colour,
             uint16_t value);

// The first depth value of each frame that is played.
std::vector<uint16_t> playedDepths(const std::filesystem::path& folder, const SourceOptions& options = {});

// Builds a RecordedCamera and reads it to its end. Returns the message of the BadInput thrown, or empty.
std::string recordingRefusal(const std::filesystem::path& folder, const SourceOptions& options = {});

} // namespace fathom
