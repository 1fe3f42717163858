// SPDX-License-Identifier: Apache-2.0
// Has third-party parsers read untrusted files in a process of their own, so that a crash of the parser
// becomes a rejected file.
#pragma once

#include "engine/model/reader_pipe.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace fathom {

// How that process runs.
struct ReaderOptions {
    std::filesystem::path program;           // empty = readerProgram()
    uint64_t mostMemory = uint64_t{4} << 30; // [bytes] of address space beyond that of an idle reader
    std::chrono::milliseconds patience = std::chrono::minutes(5); // until it is killed
};

// The program fathom-reader: in the folder of the program or library that contains this code, or in
// ../libexec/fathom or ../../libexec/fathom from there. Throws Error when there is none.
std::filesystem::path readerProgram();

// How a reader ended.
struct ReaderEnd {
    bool whole = false;   // take() got everything
    bool late = false;    // killed because its time was over
    int signal = 0;       // that ended it; 0 = none
    bool foreign = false; // another program: without the mark of this version, neither late nor by a signal
};

// Starts `fathom-reader KIND FILE MEMORY` and has take() read its answer. It has one minute of CPU time, no
// open files but its own, no signals blocked, and no error output unless it is built with a sanitizer, which
// also lifts the bound on memory. Does not fork: any thread may call it while others run. Throws Error that
// names the program when it cannot be started, and std::logic_error when a sanitizer stopped it in Fathom's
// own code.
ReaderEnd runReader(const std::string& kind, const std::filesystem::path& file, const ReaderOptions& options,
                    const std::function<bool(ReaderPipe&)>& take);

// Throws BadInput for options.program, or Error for the installed program, if the end is foreign.
void refuseForeign(const ReaderOptions& options, const ReaderEnd& end);

// "breaks the <reader>", with the signal, or that it takes too long.
std::string broken(const std::string& reader, const ReaderEnd& end);

inline constexpr int kSanitizerReport =
    86; // exit code of a reader that a sanitizer stopped outside the parser

} // namespace fathom
