// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/caption.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <ctime>

namespace fathom::operate {

namespace {

// Local time with its offset from UTC.
std::string clockNow() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    char text[64];
    if (::localtime_r(&now, &local) == nullptr || std::strftime(text, sizeof text, "%F %T %z", &local) == 0) {
        return "time unknown";
    }
    return text;
}

double letterOf(int width) {
    return std::clamp(width / 80.0, 11.0, 28.0); // [pixels]
}

} // namespace

std::vector<std::string> captionOf(const CaptionInput& input) {
    const TimeLine& line = input.mode.console.timeLine;
    const StepRecord& record = input.mode.run.step().record;
    std::string when = line.on
                           ? printed("recording, %.3f s, frame %u of %u", line.t, line.frame + 1, line.frames)
                           : clockNow();
    if (!input.pilot.empty()) {
        when += "   pilot " + input.pilot;
    }
    std::string state = modeOf(input.mode).word;
    for (const Chip& chip : chipsOf(input.mode)) {
        state += "  " + chip.word;
    }
    std::vector<std::string> lines{when, state +
                                             printed("   force %.2f N   torque %.3f N m   gap ",
                                                     glm::length(record.wrench.force),
                                                     glm::length(record.wrench.torque)) +
                                             gapText(input.cues.gap)};
    lines.insert(lines.end(), input.job.begin(), input.job.end());
    return lines;
}

int captionHeight(int width, size_t lines) {
    return lines == 0 ? 0 : static_cast<int>(letterOf(width) * (1.4 * static_cast<double>(lines) + 0.6));
}

void drawCaption(const Image& image, int top, const std::vector<std::string>& lines) {
    constexpr Colour kPlate{0.024, 0.031, 0.047}, kWords{0.92, 0.94, 0.97};
    const double letter = letterOf(image.width()), room = image.width() - letter;
    image.box(0.0, top, image.width(), image.height() - top, kPlate);
    double base = top + 1.4 * letter;
    for (std::string words : lines) {
        while (words.size() > 3 && image.textWidth(words, letter) > room) {
            do {
                words.pop_back(); // a whole character of UTF-8
            } while (words.size() > 3 && (static_cast<unsigned char>(words.back()) & 0x80u) != 0);
            words.resize(std::max<size_t>(3, words.size()) - 3);
            words += "...";
        }
        image.text(0.5 * letter, base, words, letter, kWords);
        base += 1.4 * letter;
    }
}

} // namespace fathom::operate
