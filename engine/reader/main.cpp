// SPDX-License-Identifier: Apache-2.0
// fathom-reader KIND FILE MEMORY: reads one untrusted file for another process of Fathom (reader_process.h),
// under limits, and writes the result to standard output. KIND: mesh or urdf. MEMORY [bytes].
#include "engine/model/reader_process.h"
#include "engine/reader/answers.h"

#include <cstdlib>
#include <fstream>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef FATHOM_SANITIZED
#include <sanitizer/common_interface_defs.h>
#endif

namespace {

constexpr rlim_t kMaxSeconds = 60;     // of CPU time
constexpr unsigned kMaxPatience = 600; // [s] in case the other process is gone; it is more impatient

// Address space of this process [bytes]; 0 when unknown, or under a sanitizer, which maps terabytes.
rlim_t mappedNow() {
#ifdef FATHOM_SANITIZED
    return 0;
#endif
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void limit(uint64_t mostMemory) {
    ::alarm(kMaxPatience);
    const rlimit none{0, 0}, time{kMaxSeconds, kMaxSeconds};
    ::setrlimit(RLIMIT_CORE, &none);
    ::setrlimit(RLIMIT_CPU, &time);
    if (const rlim_t mapped = mappedNow(); mapped > 0) {
        const rlimit memory{mapped + mostMemory, mapped + mostMemory};
        ::setrlimit(RLIMIT_AS, &memory);
    }
#ifdef FATHOM_SANITIZED
    __sanitizer_set_death_callback([] {
        if (fathom::ParserScope::count == 0) {
            ::_exit(fathom::kSanitizerReport);
        }
    });
#endif
}

} // namespace

int main(int count, char** arguments) {
    const std::string_view kind = count == 4 ? arguments[1] : "";
    const auto answer = kind == "mesh" ? fathom::answerMesh : kind == "urdf" ? fathom::answerUrdf : nullptr;
    if (answer == nullptr) {
        return 2;
    }
    const uint64_t mostMemory = std::strtoull(arguments[3], nullptr, 10);
    limit(mostMemory);
    const int pipe = ::dup(STDOUT_FILENO); // alone for the answer, whatever a parser prints
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    const std::string_view mark = fathom::kReaderMark;
    const bool whole =
        fathom::writeAll(pipe, mark.data(), mark.size()) && answer(arguments[2], pipe, mostMemory);
    ::_exit(whole ? 0 : 1); // without the destructors of libraries
}
