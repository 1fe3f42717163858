// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/stream_report.h"

#include "devices/bag/cloud_message.h"
#include "engine/types/error.h"
#include "engine/types/median.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <map>
#include <ostream>

namespace fathom {

namespace {

std::string padded(std::string text, size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text + "  ";
}

std::string rateText(const Rate& rate) {
    return rate.perSecond > 0.0 ? printed("%.4g/s", rate.perSecond) : "-";
}

std::string gapText(const Rate& rate) {
    return rate.gaps == 0 ? "-"
                          : std::to_string(rate.gaps) + ", " + printed("%.3g s", rate.longestGap) +
                                printed(" at %.4g s", rate.at);
}

std::map<size_t, ImageStream> imagesOf(MessageFile& file, const std::string& infoTopic, std::ostream& out) {
    std::map<size_t, ImageStream> images;
    try {
        for (ImageStream& stream : imageStreams(file, infoTopic)) {
            images.emplace(stream.topic, std::move(stream));
        }
    } catch (const Error& e) {
        out << "  images cannot be listed: " << e.what() << "\n";
    }
    return images;
}

std::string imageText(const ImageStream& image) {
    const std::string size = image.width == 0 ? "size not readable" : sizeText(image.width, image.height);
    return size + " " + image.encoding + ", frame '" + image.frame + "', lens: " +
           (image.lens ? lensText(*image.lens) + (image.rectified ? ", rectified" : "") : image.noLens);
}

// What a topic of clouds holds, by its first message.
std::string cloudText(MessageFile& file, const MessageTopic& topic) {
    try {
        const ros::Cloud cloud = ros::cloud(file.read(topic, 0));
        const std::string why = ros::whyNoDepth(cloud);
        return cloud.words() + (why.empty() ? ", organised" : ": " + why);
    } catch (const Error& e) {
        return std::string("not readable: ") + e.what();
    }
}

} // namespace

Rate Rate::of(const std::vector<MessageEntry>& messages) {
    Rate rate;
    if (messages.size() < 2 || messages.back().time <= messages.front().time) {
        return rate;
    }
    const auto seconds = [](uint64_t from, uint64_t to) { return 1e-9 * static_cast<double>(to - from); };
    std::vector<double> gaps;
    for (size_t i = 1; i < messages.size(); ++i) {
        gaps.push_back(seconds(messages[i - 1].time, messages[i].time));
    }
    const auto longest = std::ranges::max_element(gaps);
    rate.longestGap = *longest;
    rate.at = seconds(messages.front().time, messages[static_cast<size_t>(longest - gaps.begin())].time);
    std::vector<double> reordered = gaps;
    const double median = medianOf(reordered);
    rate.gaps = static_cast<size_t>(std::ranges::count_if(gaps, [&](double g) { return g > 1.5 * median; }));
    rate.perSecond = static_cast<double>(gaps.size()) / seconds(messages.front().time, messages.back().time);
    return rate;
}

std::string lensText(const Intrinsics& lens) {
    std::string text = sizeText(lens.width, lens.height) + printed(", fx %.5g", lens.fx) +
                       printed(" fy %.5g", lens.fy) + printed(" cx %.5g", lens.cx) +
                       printed(" cy %.5g", lens.cy);
    if (lens.fan) {
        return text + ", a fan of beams";
    }
    if (!lens.distorted()) {
        return text + ", no distortion";
    }
    text += lens.model == LensModel::Equidistant        ? ", equidistant"
            : lens.model == LensModel::ScaledTangential ? ", inverse_brown_conrady"
            : lens.divisor != std::array<double, 3>{}   ? ", rational_polynomial"
                                                        : ", plumb_bob";
    for (const double k : lens.distortion) {
        text += printed(" %.4g", k);
    }
    return text;
}

void writeStreams(MessageFile& file, const std::string& infoTopic, std::ostream& out) {
    const std::vector<MessageTopic>& topics = file.topics();
    std::vector<size_t> order(topics.size());
    size_t name = 5, type = 4;
    for (size_t i = 0; i < topics.size(); ++i) {
        order[i] = i;
        name = std::max(name, printable(topics[i].name).size());
        type = std::max(type, printable(topics[i].type).size());
    }
    std::ranges::stable_sort(
        order, [&](size_t a, size_t b) { return topics[a].messages.size() > topics[b].messages.size(); });
    out << "streams\n  " << padded("topic", name) << padded("type", type) << padded("messages", 8)
        << padded("rate", 9) << "gaps: longest\n";
    const auto images = imagesOf(file, infoTopic, out);
    for (const size_t i : order) {
        const MessageTopic& topic = topics[i];
        const Rate rate = Rate::of(topic.messages);
        out << "  " << padded(printable(topic.name), name) << padded(printable(topic.type), type)
            << padded(std::to_string(topic.messages.size()), 8) << padded(rateText(rate), 9) << gapText(rate)
            << "\n";
        if (const auto image = images.find(i); image != images.end()) {
            out << "      " << printable(imageText(image->second)) << "\n";
        }
        if (topic.type == ros::kCloudType && !topic.messages.empty()) {
            out << "      " << printable(cloudText(file, topic)) << "\n";
        }
    }
}

} // namespace fathom
