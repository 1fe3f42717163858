// SPDX-License-Identifier: Apache-2.0
// Targets for files that the program's commands read or write: recorded ticks, measured points, firmware.
#include "apps/operate/tick_log.h"
#include "apps/register/board_finder.h"
#include "apps/register/point_pairs.h"
#include "devices/usb/falcon_firmware.h"
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <cmath>

namespace fathom::testing {

// wrench.csv, then touches.csv after the first zero byte.
void readTicks(Bytes input) {
    const auto zero = static_cast<size_t>(std::find(input.begin(), input.end(), 0) - input.begin());
    const auto folder = fuzzFile(operate::kWrenchFile, input.first(zero)).parent_path();
    fuzzFile(operate::kTouchesFile, input.subspan(std::min(zero + 1, input.size())));
    const operate::TickLog log = operate::readTickLog(folder);
    for (size_t i = 0; i < log.ticks.size(); ++i) {
        const operate::RecordedTick& recorded = log.ticks[i];
        need(std::isfinite(recorded.t) && (i == 0 || recorded.t > log.ticks[i - 1].t));
        need(recorded.firstTouch + recorded.touchCount <= log.touches.size());
        need(log.recordAt(i).touchCount <= kMaxTouches);
    }
}

// The first byte selects pairs of points or a board pose.
void readPairs(Bytes input) {
    if (input.empty()) {
        return;
    }
    const auto file = fuzzFile("points.csv", input.subspan(1));
    if (input[0] % 2 == 0) {
        for (const PointPair& pair : readPointPairs(file)) {
            need(isFinite(pair.camera) && isFinite(pair.base) && !pair.name.empty());
        }
    } else {
        const BoardPlace board = readBoardPlace(file);
        need(board.columns >= 3 && board.columns <= 40 && board.rows >= 3 && board.rows <= 40);
        need((board.columns + board.rows) % 2 == 1 && board.square > 0.0 && isFinite(board.baseTboard));
    }
}

void readFirmware(Bytes input) {
    const std::vector<uint8_t> firmware = readFalconFirmware(fuzzFile("firmware.bin", input));
    need(std::equal(firmware.begin(), firmware.end(), input.begin(), input.end()));
}

} // namespace fathom::testing
