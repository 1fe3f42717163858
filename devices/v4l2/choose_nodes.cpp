// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/choose_nodes.h"

#include "devices/v4l2/pixel_format.h"
#include "engine/types/error.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr const char* kNeedsName =
    "a depth format (Z16, INZI), or format=Y16, Y12, Y10 or Y10B if these carry depth";

uint32_t depthFormatOf(const VideoNode& node, uint32_t requested) {
    if (requested != 0) {
        return depthLayout(requested) && node.offers(requested) ? requested : 0;
    }
    for (const uint32_t fourcc : declaredDepthFormats()) {
        if (node.offers(fourcc)) {
            return fourcc;
        }
    }
    return 0;
}

VideoNode openDepth(const CameraRequest& request, const std::optional<KnownCamera>& known,
                    std::vector<VideoNode>& nodes, const std::vector<std::string>& refused) {
    if (!known && request.device != "auto") {
        VideoNode node(request.device);
        if (depthFormatOf(node, request.format) == 0) {
            throw BadInput(request.text, "format",
                           request.format == 0
                               ? "no depth on " + request.device + ", which has " + node.offer()
                               : fourccName(request.format),
                           request.format == 0 ? kNeedsName : node.offer());
        }
        return node;
    }
    const auto fits = [&](const VideoNode& node) {
        return (!known || node.identity() == known->depthIdentity) &&
               depthFormatOf(node, request.format) != 0;
    };
    const auto found = std::find_if(nodes.begin(), nodes.end(), fits);
    if (found == nodes.end()) {
        std::string seen = nodes.empty()
                               ? "no camera found"
                               : "no depth among " + std::to_string(nodes.size()) + " video devices";
        for (const std::string& line : refused) {
            seen += "; " + line;
        }
        throw BadInput(request.text, "device", seen,
                       nodes.empty() ? "a connected camera; `fathom devices` lists them" : kNeedsName);
    }
    VideoNode node = std::move(*found);
    nodes.erase(found);
    return node;
}

// Rank of the node's best colour format in the list of formats; end of the list = none.
size_t colourRank(const VideoNode& node, uint32_t requested) {
    const auto all = colourFormats();
    for (size_t i = 0; i < all.size(); ++i) {
        if ((requested == 0 || requested == all[i]) && node.offers(all[i])) {
            return i;
        }
    }
    return all.size();
}

void takeColour(const CameraRequest& request, VideoNode node, ChosenNodes& chosen) {
    const size_t rank = colourRank(node, request.colourFormat);
    if (rank == colourFormats().size()) {
        throw BadInput(request.text, "colour",
                       request.colourFormat == 0 ? node.file().string() : fourccName(request.colourFormat),
                       "RGB3, BGR3, YUYV, UYVY, NV12 or MJPG; the device has " + node.offer());
    }
    chosen.colourFormat = colourFormats()[rank];
    chosen.colour = std::move(node);
}

void chooseColour(const CameraRequest& request, const std::string& identity, std::vector<VideoNode>& nodes,
                  ChosenNodes& chosen) {
    VideoNode* best = nullptr;
    size_t bestRank = colourFormats().size();
    for (VideoNode& node : nodes) {
        if (node.identity() == identity && node.file() != chosen.depth.file()) {
            const size_t rank = colourRank(node, request.colourFormat);
            best = rank < bestRank ? &node : best;
            bestRank = std::min(rank, bestRank);
        }
    }
    if (best != nullptr) {
        takeColour(request, std::move(*best), chosen);
    } else if (request.colourFormat != 0) {
        throw BadInput(request.text, "colour_format", fourccName(request.colourFormat),
                       "a colour format of the same camera, or colour=/dev/videoN");
    }
}

} // namespace

ChosenNodes chooseNodes(const CameraRequest& request, const std::optional<KnownCamera>& known) {
    std::vector<std::string> refused;
    std::vector<VideoNode> nodes = openVideoNodes(&refused);
    ChosenNodes chosen{openDepth(request, known, nodes, refused), 0, std::nullopt, 0};
    chosen.depthFormat = depthFormatOf(chosen.depth, request.format);
    if (known) {
        if (!known->colourIdentity.empty()) {
            chooseColour(request, known->colourIdentity, nodes, chosen);
            if (!chosen.colour) {
                throw BadInput(request.text, "colour", "gone", "the same colour camera as before");
            }
        }
    } else if (request.colour == "auto") {
        chooseColour(request, chosen.depth.identity(), nodes, chosen);
    } else if (request.colour != "none") {
        takeColour(request, VideoNode(request.colour), chosen);
    }
    return chosen;
}

} // namespace fathom
