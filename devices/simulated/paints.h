// SPDX-License-Identifier: Apache-2.0
// Paints of the simulated tank, chosen for the view through a metre of water, which absorbs a third of the
// red: only the valves appear saturated.
#pragma once

#include "devices/simulated/analytic_scene.h"

namespace fathom::paint {

// Red, green and blue in 0..255 as stored in an image, then gloss and grime (see Paint).
inline const Paint kRed{linearColour(226, 18, 16), 0.12f, 0.0f};
inline const Paint kYellow{linearColour(255, 186, 8), 0.10f, 0.0f};
inline const Paint kPanel{linearColour(98, 120, 142), 0.03f, 0.45f};
inline const Paint kSteel{linearColour(178, 182, 186), 0.45f, 0.1f};
inline const Paint kBlack{linearColour(28, 32, 36), 0.15f, 0.0f};
inline const Paint kWall{linearColour(70, 98, 112), 0.0f, 0.5f};

} // namespace fathom::paint
