// SPDX-License-Identifier: Apache-2.0
// A chessboard in a depth + colour frame, as points in the frame of the depth camera.
#pragma once

#include "apps/register/rigid_fit.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Its frame: origin in the first inner corner (board_corners.h), x along the columns, y along the rows, z
// into the board, as it is read.
struct BoardPlace {
    uint32_t columns = 0, rows = 0; // of inner corners, 3 to 40 each, their sum odd
    double square = 0.0;            // [m] edge
    Pose baseTboard;
};

// One CSV row "columns,rows,square_m,x,y,z,qx,qy,qz,qw"; lines with # are comments. Throws BadInput.
BoardPlace readBoardPlace(const std::filesystem::path& file);

class BoardFinder {
public:
    BoardFinder(const CameraInfo& camera, const BoardPlace& place)
        : camera_(camera)
        , place_(place) {}

    // All inner corners: intersections of the colour camera's rays with the plane fitted to the depth between
    // them. Empty when a corner is not visible or the depth is not planar (seen_plane.h).
    std::vector<PointPair> find(const Frame& frame);

private:
    CameraInfo camera_;
    BoardPlace place_;
    std::vector<uint8_t> grey_;
};

} // namespace fathom
