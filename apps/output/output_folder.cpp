// SPDX-License-Identifier: Apache-2.0
#include "apps/output/output_folder.h"

#include "apps/output/fixtures_ply.h"
#include "engine/types/error.h"
#include "engine/types/output_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace fathom {

namespace {

// Of every version's fault files: columns are added behind these.
constexpr std::string_view kFaultsStart = "t_s,dev_x,dev_y,dev_z,";

// The process that holds the lock, as it wrote it itself.
std::string holderOf(int descriptor) {
    char text[16] = {};
    const ssize_t size = ::pread(descriptor, text, sizeof text - 1, 0);
    const bool digits =
        size > 0 && std::all_of(text, text + size, [](unsigned char c) { return std::isdigit(c); });
    return digits ? "process " + std::string(text) : "another process";
}

// A file of this name may also be the user's own.
bool beginsWith(const std::filesystem::path& file, std::string_view text) {
    std::string start(text.size(), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    return in && start == text;
}

bool isFixtureFile(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return file.extension() == ".ply" && stem.size() >= 6 &&
           std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; }) &&
           beginsWith(file, kFixturesPlyStart);
}

// Left by FaultTrace in an earlier run.
bool isFaultFile(const std::filesystem::path& file) {
    constexpr std::string_view kStart = "fault-";
    const std::string stem = file.stem().string();
    return file.extension() == ".csv" && stem.size() > kStart.size() && stem.starts_with(kStart) &&
           stem.find_first_not_of("0123456789.", kStart.size()) == std::string::npos &&
           beginsWith(file, kFaultsStart);
}

// Of every version's arm.csv: the names of the joints are between these.
bool isArmFile(const std::filesystem::path& file) {
    constexpr size_t kLongestHeader = 65536; // [bytes]
    std::string text(kLongestHeader, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<size_t>(std::max(std::streamsize{0}, in.gcount())));
    const std::string_view header = std::string_view(text).substr(0, text.find('\n'));
    return header.starts_with("t_s,") && header.find(",grasp,residual_m,") != std::string_view::npos;
}

void removeAll(const std::filesystem::path& folder, bool (*wanted)(const std::filesystem::path&)) {
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file() && wanted(entry.path())) {
            old.push_back(entry.path());
        }
    }
    for (const auto& file : old) {
        std::filesystem::remove(file);
    }
}

[[noreturn]] void refuseFolder(const std::filesystem::path& folder, const std::string& why) {
    throw BadInput(folder.string(), "output folder", why, "a folder, existing or new, that can be written");
}

} // namespace

bool makeOutputFolder(const std::filesystem::path& folder) {
    if (folder.empty()) {
        throw BadInput("--out", "value", "empty", "a folder");
    }
    std::error_code failed;
    const bool made = std::filesystem::create_directories(folder, failed);
    if (failed == std::errc::no_space_on_device) {
        throw Error(folder.string() + ": cannot use as output folder: " + failed.message());
    }
    if (failed || !std::filesystem::is_directory(folder, failed)) {
        refuseFolder(folder, failed ? failed.message() : "not a folder");
    }
    return made;
}

// The file may be removed between open() and flock(), by the process that held it: then the lock is on a file
// without a name, and the next attempt opens the new one.
OutputLock::OutputLock(const std::filesystem::path& folder)
    : file_(folder / ".fathom.lock")
    , made_(makeOutputFolder(folder)) {
    do {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
        descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
        if (descriptor_ < 0 && (errno == EACCES || errno == EROFS)) {
            refuseFolder(folder, std::strerror(errno));
        }
        if (descriptor_ < 0) {
            throw Error(file_.string() + ": cannot create: " + std::strerror(errno));
        }
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
            const std::string holder = errno == EWOULDBLOCK ? holderOf(descriptor_) : std::strerror(errno);
            ::close(std::exchange(descriptor_, -1));
            throw BadInput(folder.string(), "output folder", "in use by " + holder,
                           "a folder of its own for each run");
        }
    } while (!isOpenAs(descriptor_, file_));
    const std::string self = std::to_string(::getpid());
    if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, self.data(), self.size(), 0) < 0) {
        const std::string reason = std::strerror(errno);
        ::close(std::exchange(descriptor_, -1));
        throw Error(file_.string() + ": cannot write: " + reason);
    }
}

OutputLock::OutputLock(OutputLock&& other) noexcept
    : file_(std::move(other.file_))
    , made_(other.made_)
    , descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputLock::~OutputLock() {
    if (descriptor_ >= 0) {
        ::unlink(file_.c_str());
        if (made_) {
            ::rmdir(file_.parent_path().c_str()); // fails unless it is empty
        }
        ::close(descriptor_);
    }
}

OutputLock prepareReplayFolder(const std::filesystem::path& folder, bool withFixtures) {
    const std::filesystem::path fixtures = folder / "fixtures";
    try {
        OutputLock lock(folder);
        if (std::filesystem::is_symlink(fixtures)) {
            throw Error(fixtures.string() + ": cannot use as output folder: a symbolic link");
        }
        if (withFixtures) {
            std::filesystem::create_directory(fixtures);
        }
        removeAll(folder, isFaultFile);
        if (std::filesystem::is_directory(fixtures)) {
            removeAll(fixtures, isFixtureFile);
        }
        return lock;
    } catch (const std::filesystem::filesystem_error& error) {
        throw Error(folder.string() + ": cannot use as output folder: " + error.code().message());
    }
}

std::vector<std::filesystem::path> outdatedArmFile(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "arm.csv";
    std::error_code failed;
    const bool outdated = std::filesystem::is_regular_file(file, failed) && isArmFile(file);
    return outdated ? std::vector{file} : std::vector<std::filesystem::path>{};
}

} // namespace fathom
