// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/replay_csv.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

ReplayCsv::ReplayCsv(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : name_(file.string())
    , lines_(file)
    , columns_(columns) {
    TextLine head;
    if (!lines_.next(head)) {
        throw BadInput(name_, "header", "missing", "the columns of replay --out");
    }
    const auto names = splitFields(head.text, ',');
    fields_ = names.size();
    for (const std::string& column : columns) {
        const auto found = std::find(names.begin(), names.end(), column);
        if (found == names.end()) {
            throw BadInput(name_, "column " + column, "missing", "the columns of replay --out");
        }
        places_.push_back(static_cast<size_t>(found - names.begin()));
    }
}

void ReplayCsv::refuse(const TextLine& line, const std::string& field, const std::string& value) const {
    throw BadInput(name_, "line " + std::to_string(line.number) + ": " + field, value,
                   "finite numbers, " + std::to_string(fields_) + " fields");
}

std::optional<std::vector<double>> ReplayCsv::next() {
    TextLine line;
    if (!lines_.next(line)) {
        return std::nullopt;
    }
    const auto fields = splitFields(line.text, ',');
    if (fields.size() != fields_) {
        refuse(line, "fields", std::to_string(fields.size()));
    }
    std::vector<double> values(places_.size());
    for (size_t i = 0; i < places_.size(); ++i) {
        if (!parseNumber(fields[places_[i]], values[i]) || !std::isfinite(values[i])) {
            refuse(line, columns_[i], std::string(fields[places_[i]].substr(0, 80)));
        }
    }
    return values;
}

} // namespace fathom
