// SPDX-License-Identifier: Apache-2.0
#include "devices/images/exr_channel.h"

#include "engine/types/error.h"
#include "engine/types/lower_case.h"

#include <algorithm>
#include <optional>

namespace fathom {

namespace {

// In lower case.
struct ExrName {
    std::string layer; // empty, or with its dot
    std::string last;

    explicit ExrName(const std::string& written) {
        const std::string name = lowerCase(written);
        const size_t end = name.rfind('.') + 1; // 0 without a dot
        layer = name.substr(0, end);
        last = name.substr(end);
    }
};

class ExrChoice {
public:
    explicit ExrChoice(const std::vector<ExrChannel>& channels)
        : channels_(channels) {
        for (const ExrChannel& channel : channels) {
            names_.emplace_back(channel.name);
        }
    }

    // 5: names depth, down to 0: is not it.
    int rank(size_t channel) const {
        const auto& [layer, last] = names_[channel];
        if (layer.ends_with("mist.") || layer.ends_with("denoising depth.")) { // 0 to 1, and a ray's length
            return 0;
        }
        if (last == "depth" || (last == "z" && layer.empty())) {
            return layer.empty() ? 5 : 4;
        }
        const bool vector = siblingOf(layer, "x") || (last != "y" && siblingOf(layer, "y"));
        if (layer.ends_with("depth.") && (last == "z" || last == "r" || last == "v" || last == "y")) {
            return 4;
        }
        if (last == "z") {
            return vector ? 0 : 3;
        }
        if (channels_.size() == 1 || (last == "y" && !siblingOf(layer, "x") && !siblingOf(layer, "z"))) {
            return 2;
        }
        return last == "r" && (alone(layer) || !siblingOf(layer, "g")) ? 1 : 0;
    }

    ExrDepth choice(size_t depth) const {
        ExrDepth chosen{depth, {}};
        for (const char* colour : {"g", "b"}) {
            const auto other = siblingOf(names_[depth].layer, colour);
            if (names_[depth].last == "r" && other) {
                chosen.equal.push_back(*other);
            }
        }
        return chosen;
    }

private:
    // The channel of that layer with this last name.
    std::optional<size_t> siblingOf(const std::string& layer, std::string_view last) const {
        const auto found =
            std::ranges::find_if(names_, [&](const auto& n) { return n.layer == layer && n.last == last; });
        return found == names_.end() ? std::nullopt
                                     : std::optional(static_cast<size_t>(found - names_.begin()));
    }
    // There is no other layer, whose name might tell that this one shows colours.
    bool alone(const std::string& layer) const {
        return std::ranges::all_of(names_, [&](const ExrName& name) { return name.layer == layer; });
    }

    const std::vector<ExrChannel>& channels_;
    std::vector<ExrName> names_;
};

std::string listed(const std::vector<ExrChannel>& channels) {
    std::string names;
    for (const ExrChannel& channel : channels) {
        names += (names.empty() ? "" : ", ") + channel.name;
    }
    return names.substr(0, 80);
}

} // namespace

ExrDepth chooseExrDepth(const std::vector<ExrChannel>& channels) {
    const ExrChoice choice(channels);
    size_t best = 0;
    int most = 0;
    std::string twin;
    for (size_t i = 0; i < channels.size(); ++i) {
        const int rank = choice.rank(i);
        twin = rank > most ? "" : (rank == most ? channels[i].name : twin);
        best = rank > most ? i : best;
        most = std::max(most, rank);
    }
    if (most == 0 || channels[best].kind == 0) {
        throw Error("EXR: channels: " + listed(channels) +
                    " (allowed: Z, depth, a layer Depth, Y, R or a single one, of floating point)");
    }
    if (!twin.empty()) {
        throw Error("EXR: channels: " + channels[best].name.substr(0, 80) + " and " + twin.substr(0, 80) +
                    " (allowed: one that may be depth)");
    }
    return choice.choice(best);
}

} // namespace fathom
