// SPDX-License-Identifier: Apache-2.0
// Videos, with an encoder that stores what it gets.
#include "apps/operate/video_file.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

TEST_CASE("An image of another size ends a video, which keeps the images before it") {
    const ScratchFolder scratch;
    const auto encoder = scratch.path() / "encoder", file = scratch.path() / "video.mp4";
    put(encoder, "#!/bin/sh\nfor last; do :; done\ncat > \"$last\"\n");
    std::filesystem::permissions(encoder, std::filesystem::perms::owner_all);
    VideoFile video(encoder, file, 8, 4);
    const Image same(8, 4, {0.0, 0.0, 0.0}), other(8, 6, {0.0, 0.0, 0.0});
    video.add(same);
    video.add(same);
    CHECK_THROWS_WITH_AS(video.add(other), "the images' size changed from 8x4 to 8x6, which a video cannot",
                         Error);
    video.finish();
    CHECK(std::filesystem::file_size(file) == 2 * 8 * 4 * 4);
}
