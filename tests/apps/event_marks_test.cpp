// SPDX-License-Identifier: Apache-2.0
// Marks of a recording: read, added, and refused where they are damaged.
#include "apps/operate/event_marks.h"

#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

std::string marksRefusal(const std::filesystem::path& folder, const std::string& text) {
    std::ofstream(folder / kMarksFile) << text;
    return refusalOf([&] { readMarks(folder); });
}

} // namespace

TEST_CASE("Marks are added at any time, sorted, and come back from the file") {
    const ScratchFolder scratch;
    std::vector<EventMark> marks = readMarks(scratch.path());
    CHECK(marks.empty());
    addMark(scratch.path(), marks, 2.5);
    addMark(scratch.path(), marks, 0.125);
    REQUIRE(marks.size() == 2);
    CHECK(marks[0].name == "mark 2");
    const std::vector<EventMark> read = readMarks(scratch.path());
    REQUIRE(read.size() == 2);
    CHECK(read[0].t == 0.125);
    CHECK(read[1].name == "mark 1");
    std::ofstream(scratch.path() / kMarksFile) << "t_s,name\n3,late\n1,early\n";
    CHECK(readMarks(scratch.path())[0].name == "early");
    CHECK_THROWS_AS(addMark(scratch.path() / "missing", marks, 1.0), Error);
    CHECK(marks.size() == 2);
}

TEST_CASE("A damaged file of marks is refused in one line with file, line and what is allowed") {
    const ScratchFolder scratch;
    CHECK(marksRefusal(scratch.path(), "time\n1,a\n").find("t_s,name") != std::string::npos);
    for (const char* row : {"-1,a", "x,a", "nan,a", "1", "1,a,b"}) {
        const std::string why =
            marksRefusal(scratch.path(), std::string("t_s,name\n0.5,mark 1\n") + row + "\n");
        CHECK(why.find("marks.csv") != std::string::npos);
        CHECK(why.find("line 3") != std::string::npos);
        CHECK(why.find("a time in seconds") != std::string::npos);
        CHECK(why.find('\n') == std::string::npos);
    }
    std::string many = "t_s,name\n";
    for (int i = 0; i <= 10'000; ++i) {
        many += "1,a\n";
    }
    CHECK(marksRefusal(scratch.path(), many).find("10000 marks") != std::string::npos);
}
