// SPDX-License-Identifier: Apache-2.0
// Readers that misbehave, as shell scripts in place of fathom-reader.
#include "engine/model/reader_process.h"

#include "engine/model/import_triangles.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <csignal>
#include <doctest/doctest.h>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace fathom;

namespace {

class Script {
public:
    explicit Script(const std::string& text)
        : file_("reader", "#!/bin/sh\n" + text + '\n') {
        std::filesystem::permissions(file_.path(), std::filesystem::perms::owner_all);
    }
    ReaderOptions options() const {
        ReaderOptions options;
        options.program = file_.path();
        return options;
    }

private:
    testing::ScratchFile file_;
};

const std::string kMark = "printf '" + std::string(kReaderMark) + "'; ";

ReaderEnd endOf(const std::string& text, const ReaderOptions* changed = nullptr) {
    const Script script(text);
    ReaderOptions options = script.options();
    options.patience = changed != nullptr ? changed->patience : options.patience;
    return runReader("mesh", "x.dae", options, [](ReaderPipe& pipe) {
        char byte = 0;
        return pipe.read(&byte, 1) && byte == 'y';
    });
}

bool noChildren() {
    return ::waitpid(-1, nullptr, WNOHANG) == -1;
}

} // namespace

TEST_CASE("A reader killed by a signal reports which, and one that exits normally reports none") {
    CHECK(endOf(kMark + "printf y").whole);
    CHECK(endOf(kMark + "printf y").signal == 0);
    CHECK(endOf("kill -SEGV $$").signal == SIGSEGV);
    const ReaderEnd aborted = endOf(kMark + "kill -ABRT $$");
    CHECK_FALSE(aborted.whole);
    CHECK(broken("mesh reader", aborted) == "breaks the mesh reader (signal 6)");
}

TEST_CASE("An answer of another version, a wrong one and an incomplete one are not whole") {
    CHECK_FALSE(endOf("printf 'fathom 0y'").whole);
    CHECK_FALSE(endOf("printf 'usage: ...'; cat /dev/zero").whole); // never ends by itself
    CHECK_FALSE(endOf(kMark + "printf n; sleep 100").whole);
    CHECK_FALSE(endOf(kMark).whole);
    CHECK(noChildren());
}

TEST_CASE("A reader that takes too long is killed, before and after its answer") {
    ReaderOptions impatient;
    impatient.patience = std::chrono::milliseconds(200);
    const ReaderEnd silent = endOf(kMark + "exec sleep 100", &impatient);
    CHECK(silent.late);
    CHECK(broken("mesh reader", silent) == "takes too long for the mesh reader");
    CHECK(endOf(kMark + "printf y; exec sleep 100", &impatient).whole);
    CHECK_FALSE(endOf(kMark + "exec sleep 100 >/dev/null", &impatient).whole);
    CHECK(noChildren());
}

TEST_CASE("A program that is missing is named in one line") {
    ReaderOptions options;
    options.program = "/nowhere/fathom-reader";
    CHECK_THROWS_WITH_AS(importTriangles("x.stl", options),
                         "/nowhere/fathom-reader: cannot be started: No such file or directory (allowed: the "
                         "program fathom-reader of this version)",
                         Error);
}

TEST_CASE("A program that is not fathom-reader of this version is named, not the file") {
    for (const char* text :
         {"exit 0", "exit 1", "printf 'fathom 0y'", "printf 'usage: ...'; cat /dev/zero"}) {
        const Script other(text);
        const std::string line = "options: reader: " + other.options().program.string() +
                                 " (allowed: the program fathom-reader of this version; empty = the "
                                 "installed one)";
        CHECK_THROWS_WITH_AS(importTriangles("x.stl", other.options()), line.c_str(), BadInput);
        CHECK_THROWS_WITH_AS(readUrdf("x.urdf", other.options()), line.c_str(), BadInput);
    }
    CHECK_FALSE(endOf(kMark).foreign);
    CHECK_FALSE(endOf("kill -SEGV $$").foreign);
}

TEST_CASE("Answers beyond the bounds are rejected") {
    const std::string noFault = kMark + "printf '\\0\\0\\0\\0\\0\\0\\0\\0'; "; // an empty text
    const std::string huge = "printf '\\377\\377\\377\\377\\377\\377\\377\\0'; cat /dev/zero";
    const Script points(noFault + huge);
    CHECK(importTriangles("x.stl", points.options()).fault == "breaks the mesh reader");
    CHECK_THROWS_WITH_AS(readUrdf("x.urdf", points.options()),
                         "x.urdf: robot: breaks the URDF reader (allowed: a URDF robot)", BadInput);
    const Script text(kMark + huge);
    CHECK(importTriangles("x.stl", text.options()).fault == "breaks the mesh reader");
    // One point, and a triangle of points that are not there.
    const Script corners(
        noFault +
        "printf '\\1\\0\\0\\0\\0\\0\\0\\0\\1\\0\\0\\0\\0\\0\\0\\0'; head -c 36 /dev/zero | tr '\\0' '\\1'");
    CHECK(importTriangles("x.stl", corners.options()).fault == "breaks the mesh reader");
    const Script packet(noFault + "printf '\\20\\0\\0\\0\\0\\0\\0\\0'; head -c 16 /dev/zero"); // no links
    CHECK_THROWS_AS(readUrdf("x.urdf", packet.options()), BadInput);
}

TEST_CASE("A reader inherits no open files, no blocked signals and no terminal input") {
    const int open = ::open("/dev/null", O_RDONLY); // as another library opens it: without O_CLOEXEC
    REQUIRE(open >= 3);
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before);
    // A shell has its script open at 10 or above.
    const ReaderEnd end = endOf(kMark + "for n in 3 4 5 6 7 8 9; do [ ! -e /proc/$$/fd/$n ] || exit 1; done; "
                                        "grep -q 'SigBlk:.0000000000000000' /proc/self/status || exit 1; "
                                        "read -r line && exit 1; printf y");
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    ::close(open);
    CHECK(end.whole);
}

TEST_CASE("Readers may be started while other threads run and start readers, too") {
    std::vector<std::jthread> threads;
    std::atomic<int> whole{0};
    const Script script(kMark + "printf y");
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            const ReaderEnd end = runReader("mesh", "x", script.options(), [](ReaderPipe& pipe) {
                char byte = 0;
                return pipe.read(&byte, 1);
            });
            whole += end.whole ? 1 : 0;
        });
    }
    threads.clear();
    CHECK(whole == 8);
}

TEST_CASE("A sanitizer report of a reader is a finding, unless it occurred in the parser") {
    CHECK_THROWS_AS(endOf("exit " + std::to_string(kSanitizerReport)), std::logic_error);
    CHECK_FALSE(endOf("exit 1").whole);
}
