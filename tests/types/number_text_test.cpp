// SPDX-License-Identifier: Apache-2.0
#include "engine/types/number_text.h"

#include "engine/types/joined.h"

#include <doctest/doctest.h>
#include <vector>

using namespace fathom;

TEST_CASE("Numbers in messages have the asked significant digits and no trailing zeros") {
    CHECK(significant(0.5, 4) == "0.5");
    CHECK(significant(1.0 / 3.0, 4) == "0.3333");
    CHECK(significant(123456.0, 4) == "1.235e+05");
    CHECK(significant(-1.0 / 3.0, 17) == "-0.33333333333333331");
}

TEST_CASE("Quotes, backslashes and control characters of a quoted text are escaped, UTF-8 is kept") {
    CHECK(doubleQuoted("") == R"("")");
    CHECK(doubleQuoted(R"(a "b" \c)") == R"("a \"b\" \\c")");
    CHECK(doubleQuoted("a\nb\tc\x01") == R"("a\u000ab\u0009c\u0001")");
    CHECK(doubleQuoted("gr\xc3\xbc\xc3\x9f") == "\"gr\xc3\xbc\xc3\x9f\"");
}

TEST_CASE("A list in a message has its separator between elements only") {
    CHECK(joined(std::vector<std::string>{}).empty());
    CHECK(joined(std::vector<std::string>{"a"}) == "a");
    CHECK(joined(
              std::vector<int>{1, 2, 3}, [](int i) { return std::to_string(i); }, "; ") == "1; 2; 3");
}
