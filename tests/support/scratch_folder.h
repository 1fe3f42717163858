// SPDX-License-Identifier: Apache-2.0
// Temporary folders and files of one test, and functions that read and write whole files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace fathom::testing {

inline std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

// A new folder, removed at the end of the test. Its name is unique, because suites run in several processes
// at the same time.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "fathom-test-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw std::runtime_error("the test cannot make the folder " + name);
        }
        path_ = name;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    // Writes a file, and the folders above it.
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        put(path_ / name, text);
    }
    std::string read(const std::string& name) const { return textOf(path_ / name); }
    // Number of files in the folder, which reveals a temporary file left behind.
    size_t files() const {
        return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

// A file in a folder of its own.
class ScratchFile {
public:
    explicit ScratchFile(const std::string& name, const std::string& text = "")
        : path_(folder_ / name) {
        put(path_, text);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    ScratchFolder folder_;
    std::filesystem::path path_;
};

} // namespace fathom::testing
