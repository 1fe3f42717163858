// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/arm_notes.h"

#include "engine/contact/shapes.h"
#include "engine/haptics/held_leaves.h"
#include "engine/types/joined.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// Where the leaves of each link are, with regard to one shape.
struct LinksInShape {
    std::vector<std::string> held, partly, outside, stuck;
};

void addTo(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
    }
}

LinksInShape linksIn(const Shape& shape, const ArmSetup& setup) {
    const ArmModel& model = setup.model;
    const ArmFrames frames = setup.framesAt(setup.startPosture());
    std::vector<size_t> leaves(model.links.size()), out(model.links.size());
    LinksInShape links;
    for (size_t i = 0; i < model.leaves.size(); ++i) {
        const dvec3 centre = model.centre(frames, i);
        const double radius = model.leaves[i].sphere.radius;
        const uint32_t link = model.leaves[i].link;
        ++leaves[link];
        out[link] += isOutside(shape, centre, radius) ? 1 : 0;
        if (!shape.keepIn && gapTo(shape, centre, radius).gap < -kJustOutside && !model.moves(i)) {
            addTo(links.stuck, model.links[link]);
        }
    }
    for (size_t link = 0; link < leaves.size(); ++link) {
        if (leaves[link] > 0) {
            (out[link] == 0              ? links.held
             : out[link] == leaves[link] ? links.outside
                                         : links.partly)
                .push_back(model.links[link]);
        }
    }
    return links;
}

std::string linkList(const std::vector<std::string>& names) {
    return (names.size() == 1 ? "link " : "links ") + joined(names);
}

std::string keepInNote(const LinksInShape& links) {
    if (links.held.empty() && links.partly.empty()) {
        return "keeps no link inside, because all are outside of it at the start";
    }
    std::string text = "keeps ";
    text += links.held.empty() ? "" : linkList(links.held);
    if (!links.partly.empty()) {
        text += (links.held.empty() ? "parts of " : " and parts of ") + linkList(links.partly);
    }
    text += " inside";
    if (!links.outside.empty()) {
        text += "; not " + joined(links.outside) + ", outside of it at the start";
    }
    return text;
}

} // namespace

std::vector<std::string> shapeNotes(const Scene& scene, const ArmSetup& setup) {
    std::vector<std::string> notes;
    for (const Shape& shape : shapesOf(scene)) {
        if (shape.isEquality()) {
            continue;
        }
        const std::string fixture = "fixture '" + scene.fixtures[shape.fixture].name + "': ";
        const LinksInShape links = linksIn(shape, setup);
        if (shape.keepIn && links.held.size() < setup.model.links.size()) {
            notes.push_back(fixture + keepInNote(links));
        }
        for (const std::string& link : links.stuck) {
            notes.push_back(fixture + "link " + link +
                            " is inside of it, and no joint moves that link: it stays");
        }
    }
    return notes;
}

GraspTime graspTimeOf(const ArmModel& model) {
    GraspTime slowest;
    for (const ArmFinger& finger : model.fingers) {
        const double seconds = finger.mimic ? 0.0 : std::abs(finger.closed - finger.open) / finger.speed;
        if (seconds > slowest.seconds) {
            slowest = {seconds, finger.name,
                       significant(finger.speed, 4) + (finger.slides ? " m/s" : " rad/s")};
        }
    }
    return slowest;
}

} // namespace fathom
