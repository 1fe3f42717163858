// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/line_file.h"

#include "engine/types/error.h"

#include <cerrno>
#include <cstring>
#include <iomanip>
#include <system_error>

namespace fathom {

void LineFile::open(const std::filesystem::path& file, const char* header) {
    name_ = file;
    size_ = 0;
    out_ = std::ofstream(file, std::ios::binary);
    if (!out_) {
        throw Error(file.string() + ": cannot be written");
    }
    waiting_.str("");
    waiting_ << std::setprecision(17) << header << (*header != 0 ? "\n" : "");
    flush();
}

void LineFile::flush() {
    if (!out_.is_open()) {
        return;
    }
    const std::string text = waiting_.str();
    waiting_.str("");
    errno = 0;
    out_ << text << std::flush;
    if (out_) {
        size_ += text.size();
        return;
    }
    const std::string why = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
    out_.close();
    std::error_code ignored; // truncation may be impossible, for example on a device
    std::filesystem::resize_file(name_, size_, ignored);
    throw Error(name_.string() + ": cannot be written" + why);
}

void LineFile::close() {
    flush();
    out_.close();
}

} // namespace fathom
