// SPDX-License-Identifier: Apache-2.0
// Recording folders made for a test, and the real ones beside the repository.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// Where the real recordings are, seen from the repository root.
inline const std::filesystem::path kRecordings = "../shared/data";

// False, and said aloud, when the recording is not there.
bool haveRecording(const std::string& name);

// A folder under the system's temporary one that goes when the test ends.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;

private:
    std::filesystem::path path_;
};

// PNG of rows of raw bytes as libpng takes them (16-bit values big-endian). colourType: 0 grey, 2 RGB, 3
// palette, 4 grey + alpha, 6 RGBA. A palette has the three colours red, green, blue.
void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height, int bits, int colourType,
              const std::vector<uint8_t>& bytes, bool interlaced = false);

// width x height, every depth pixel `value`.
void writeDepth(const std::filesystem::path& file, uint32_t width, uint32_t height, uint16_t value);
// Every pixel r, g, b.
void writeColour(const std::filesystem::path& file, uint32_t width, uint32_t height, uint8_t r, uint8_t g,
                 uint8_t b);

// A sound recording of `frames` pairs of 7 x 5 pictures: depth 1000 + i, colour (i, 20, 30), stamps i / 10 s.
inline constexpr uint32_t kSmallWidth = 7, kSmallHeight = 5;
extern const std::string kSmallIntrinsics;
void writeSmallRecording(const TemporaryFolder& folder, uint32_t frames);

// The message of the BadInput that building a RecordedCamera and reading it to its end throws; empty when
// none does.
std::string recordingRefusal(const std::filesystem::path& folder);

} // namespace fathom
