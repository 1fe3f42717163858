// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace fathom;

namespace {

void checkRefusedArguments(const std::vector<std::string>& arguments, const std::string& line) {
    const ProgramRun run = runFathom(arguments);
    CAPTURE(run.err);
    CHECK(run.exitCode == 2);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(run.err.find(line) == 0);
}

} // namespace

TEST_CASE("The help of an option names the words that it accepts") {
    CHECK(runFathom({"replay", "--help"}).out.find("--query TEXT:{cpu,gpu}") != std::string::npos);
    CHECK(runFathom({"guard", "--help"}).out.find("{falcon,haply,ros2}") != std::string::npos);
    CHECK(runFathom({"spheres", "--help"}).out.find("{x,y,z}") != std::string::npos);
}

TEST_CASE("The help of each subcommand says where the options of every subcommand are") {
    for (const char* command : {"replay", "operate", "guard", "plan", "profile"}) {
        CAPTURE(command);
        const std::string help = runFathom({command, "--help"}).out;
        CHECK(help.find("\nOptions of every subcommand, such as --device and --verbose: fathom --help\n") !=
              std::string::npos);
    }
}

TEST_CASE("A wrong command line is rejected in one line that says what is wrong with it") {
    checkRefusedArguments({"--out", "X", "replay", "a.yaml"},
                          "fathom: replay: --out: before the subcommand (allowed: after it: fathom replay");
    checkRefusedArguments({"--device"}, "fathom: --device: value missing (");
    checkRefusedArguments({"--nosuch"}, "fathom: option: '--nosuch' (allowed: --help, --device, ");
    checkRefusedArguments({}, "fathom: subcommand: missing (allowed: replay, operate, ");
    checkRefusedArguments({"a.yaml"},
                          "fathom: subcommand: missing before 'a.yaml' (for example: fathom replay");
    checkRefusedArguments({"replya"}, "fathom: subcommand: 'replya', did you mean 'replay'? (allowed: ");
    checkRefusedArguments({"TUNE"}, "fathom: subcommand: 'TUNE', did you mean 'tune'? (allowed: ");
    checkRefusedArguments({"plan", "a.yaml", "--Source", "x"},
                          "fathom: plan: '--Source', did you mean '--source'? (allowed: ");
    checkRefusedArguments({"replay", "a.yaml", "b.yaml"}, "fathom: replay: 'b.yaml': one SCENE only");
    checkRefusedArguments({"replay", "--scene", "a.yaml"}, "fathom: replay: --scene: SCENE is given without");
    CHECK(runFathom({}).err.find("; see fathom --help\n") != std::string::npos);
}

TEST_CASE("fathom help prints the help of the program, or of a subcommand") {
    CHECK(runFathom({"help"}).out == runFathom({"--help"}).out);
    CHECK(runFathom({"help", "plan"}).out == runFathom({"plan", "--help"}).out);
    checkRefusedArguments({"help", "plna"}, "fathom: help: subcommand: plna (allowed: ");
}

TEST_CASE("Standard output that takes nothing, as on a full disk, is an error") {
    CHECK(exitCodeOf(startFathom({"stability", "--list"}, "/dev/null")) == 0);
    CHECK(exitCodeOf(startFathom({"stability", "--list"}, "/dev/full")) == 1);
}

TEST_CASE("An empty output folder or scene, and a trace that cannot be written, are rejected in one line") {
    const testing::ScratchFolder folder;
    checkRefusedArguments({"replay", "apps/scenes/demo.yaml", "--out", ""},
                          "fathom: --out: value: empty (allowed");
    checkRefusedArguments({"plan", ""}, "fathom: '': file: no such file (allowed: a readable scene file");
    checkRefusedArguments({"plan", "apps/scenes/demo.yaml", "--source", "none.bag"},
                          "fathom: none.bag: file: ");
    checkRefusedArguments({"replay", "apps/scenes/demo.yaml", "--out", (folder.path() / "out").string(),
                           "--trace", "/no/such/t.json"},
                          "fathom: trace: file: /no/such/t.json: cannot create: No such file");
}

TEST_CASE("Subcommands that write no trace warn that --trace is not used") {
    const testing::ScratchFolder folder;
    const std::string trace = (folder.path() / "t.json").string(), scene = "apps/scenes/demo.yaml";
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"plan", scene}, {"stability", "--list"}}) {
        std::vector<std::string> words{"--trace", trace};
        words.insert(words.end(), command.begin(), command.end());
        const ProgramRun run = runFathom(words);
        CHECK(run.exitCode == 0);
        CHECK(run.err.find("warning: " + command[0] +
                           ": --trace is not used: replay and profile write a trace\n") != std::string::npos);
    }
    CHECK(folder.files() == 0);
}

TEST_CASE("An option with an empty value, as from an unset shell variable, is rejected in one line") {
    const testing::ScratchFolder folder;
    const std::string scene = "apps/scenes/demo.yaml", out = (folder.path() / "out").string();
    const auto refused = [](std::vector<std::string> command, const std::string& option) {
        CAPTURE(option);
        command.insert(command.end(), {option, ""});
        checkRefusedArguments(command, "fathom: " + command[0] + ": " + option +
                                           ": value: empty (allowed: a value, or no " + option + ")");
    };
    for (const char* option : {"--source", "--operator", "--hand-device", "--arm", "--trace", "--device"}) {
        refused({"replay", scene, "--out", out}, option);
    }
    refused({"operate", scene}, "--state");
    refused({"spheres", "a.urdf", "--out", "a.sph"}, "--link");
    refused({"spheres", "a.urdf", "--out", "a.yaml"}, "--meshes");
    CHECK(folder.files() == 0);
}

TEST_CASE(
    "A missing bridge is named with the command that starts it, and an unknown device with those there are") {
    const auto refused = [](const std::string& hand, const std::string& line) {
        checkRefusedArguments(
            {"replay", "apps/scenes/demo.yaml", "--out", "none", "--realtime", "--hand-device", hand}, line);
    };
    refused("omega", "fathom: --hand-device: omega: no such device and no socket (allowed: falcon, ");
    const testing::ScratchFolder folder;
    ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
    refused(
        "haply",
        "fathom: socket: " + (folder.path() / "fathom-haply.door").string() +
            ": no bridge listens (allowed: the socket of a running bridge, such as `fathom guard haply`)");
    ::unsetenv("XDG_RUNTIME_DIR");
    refused("falcon",
            "fathom: socket: path: missing, and XDG_RUNTIME_DIR is not set (allowed: --hand-device PATH");
}
