// SPDX-License-Identifier: Apache-2.0
// The answers of fathom-reader: third-party parsers read a file, and the result goes to a pipe.
#pragma once

#include <cstdint>
#include <filesystem>

namespace fathom {

// Each returns whether all was written. A fault of the file is part of the answer. mostMemory [bytes]: named
// in it when memory runs out.
bool answerMesh(const std::filesystem::path& file, int pipe, uint64_t mostMemory);
bool answerUrdf(const std::filesystem::path& file, int pipe, uint64_t mostMemory);

// While one exists, a parser runs: a sanitizer report is then the parser's fault and rejects the file, as a
// crash does.
class ParserScope {
public:
    ParserScope() noexcept { ++count; }
    ~ParserScope() { --count; }
    ParserScope(const ParserScope&) = delete;
    ParserScope& operator=(const ParserScope&) = delete;

    static inline int count = 0; // the reader has one thread
};

} // namespace fathom
