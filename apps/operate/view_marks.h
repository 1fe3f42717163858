// SPDX-License-Identifier: Apache-2.0
// Marks over a view: outlines of regions, guidance, tool and device ghost, contacts, force.
#pragma once

#include "apps/operate/camera_view_image.h"
#include "apps/operate/depth_cues.h"
#include "apps/operate/measured_arm.h"
#include "apps/operate/run_view.h"
#include "apps/operate/view_port.h"
#include "engine/contact/shapes.h"
#include "engine/contact/tool.h"
#include "engine/cycle/arm_setup.h"

#include <span>
#include <string>
#include <vector>

namespace fathom::operate {

// What the marks show; references must stay valid during the call only.
struct MarksInput {
    const ViewPort& port;
    const RunView& run;
    const Tool& tool;
    const Scene& scene; // for the names
    std::span<const Shape> shapes;
    std::span<const Sphere> arm; // the arm in the base frame; empty = the tool moves freely
    const ShownArm& measured;    // the real arm
    const DepthCues& cues;
    const SurfaceDepth& surface; // of this view
    bool names = true;           // labels at guidance and force; off in the small view
};

// The spheres of every link in the base frame; empty without an arm.
std::vector<Sphere> armSpheres(const ArmSetup* arm, const ArmPosture& posture);

void drawRegionOutlines(ImDrawList& list, const ViewPort& port, const CameraViewImage& image);
void drawBounds(ImDrawList& list, const ViewPort& port, std::span<const Sphere> bounds);
void drawCameraFrustum(ImDrawList& list, const ViewPort& port, const HostFixtures& set);
// Draws shapes, guidance, shadow, device ghost, tool, tether, contacts and force, in this order. Returns the
// share of the tool's outline that is hidden.
double drawMarks(ImDrawList& list, const MarksInput& input);

// Text on a dark plate, whose corners it returns.
ImVec4 drawWords(ImDrawList& list, ImVec2 at, const std::string& words, ImU32 colour);
void drawArrow(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 colour, float width);

} // namespace fathom::operate
