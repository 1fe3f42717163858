// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/event_marks.h"

#include "devices/recorded/line_file.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr size_t kMaxMarks = 10'000;

bool earlier(const EventMark& a, const EventMark& b) {
    return a.t < b.t;
}

} // namespace

std::vector<EventMark> readMarks(const std::filesystem::path& folder) {
    std::vector<EventMark> marks;
    const std::filesystem::path file = folder / kMarksFile;
    if (!std::filesystem::exists(file)) {
        return marks;
    }
    DataLines lines(file);
    TextLine line{1, ""};
    const auto refuse = [&](const std::string& value, const std::string& allowed) {
        throw BadInput(file.string(), "line " + std::to_string(line.number), "'" + value.substr(0, 80) + "'",
                       allowed);
    };
    if (!lines.next(line) || line.text != kMarksHeader) {
        refuse(std::string(line.text), kMarksHeader);
    }
    while (lines.next(line)) {
        const std::vector<std::string_view> fields = splitFields(line.text, ',');
        EventMark mark;
        if (fields.size() != 2 || !parseNumber(fields[0], mark.t) || !std::isfinite(mark.t) || mark.t < 0.0) {
            refuse(std::string(line.text), "a time in seconds from 0 on, and a name");
        }
        if (marks.size() >= kMaxMarks) {
            refuse("one more", "10000 marks");
        }
        mark.name = fields[1].substr(0, 80);
        marks.push_back(std::move(mark));
    }
    std::stable_sort(marks.begin(), marks.end(), earlier);
    return marks;
}

void addMark(const std::filesystem::path& folder, std::vector<EventMark>& marks, double t) {
    if (marks.size() >= kMaxMarks) {
        throw Error((folder / kMarksFile).string() + ": has 10000 marks already");
    }
    std::vector<EventMark> next = marks;
    const EventMark fresh{t, "mark " + std::to_string(marks.size() + 1)};
    next.insert(std::upper_bound(next.begin(), next.end(), fresh, earlier), fresh);
    const std::filesystem::path file = folder / kMarksFile,
                                half = folder / (std::string(kMarksFile) + ".new");
    LineFile out;
    out.open(half, kMarksHeader);
    for (const EventMark& mark : next) {
        out.lines() << mark.t << "," << mark.name << "\n";
    }
    out.close();
    std::error_code failed;
    std::filesystem::rename(half, file, failed);
    if (failed) {
        throw Error(file.string() + ": cannot be written (" + failed.message() + ")");
    }
    marks = std::move(next);
}

} // namespace fathom::operate
