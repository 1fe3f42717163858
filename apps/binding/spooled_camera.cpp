// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/spooled_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace fathom {

SpooledCamera::SpooledCamera(std::unique_ptr<Camera> source, const std::filesystem::path& folder,
                             const std::atomic<bool>& stop, const std::function<void(uint64_t)>& progress,
                             std::optional<uint32_t> still)
    : info_(source->info())
    , description_(source->description())
    , folder_(folder.string()) {
    std::string name = (folder / ".frames-XXXXXX").string();
    descriptor_ = ::mkstemp(name.data());
    if (descriptor_ < 0) {
        fail("cannot be written");
    }
    ::unlink(name.c_str());
    try {
        while (stored_.empty() || (!still && !stop.load())) {
            const std::optional<Frame> frame = source->next();
            if (!frame) {
                break;
            }
            store(*frame);
            progress(stored_.size());
        }
    } catch (...) {
        ::close(descriptor_);
        throw;
    }
    count_ = stored_.empty() ? 0 : still.value_or(stored_.size());
    skipped_ = source->skipped();
    warnings_ = source->warnings();
    slots_ = std::make_unique<FrameSlots>(info_.slotPixels(), info_.hasColour, kFramesInFlight + 1);
}

SpooledCamera::~SpooledCamera() {
    ::close(descriptor_);
}

void SpooledCamera::fail(const char* what) const {
    throw Error("frames kept in " + folder_ + ": " + what + " (" + std::strerror(errno) + ")");
}

void SpooledCamera::store(const Frame& frame) {
    const std::span<const std::byte> colours = frame->colourBytes();
    writeAll(frame->depth.data(), frame->depth.size_bytes());
    writeAll(colours.data(), colours.size());
    StoredFrame& stored = stored_.emplace_back(StoredFrame{*frame, colours.size()});
    stored.content.depth = {};
    stored.content.setColourBytes({});
    stored.content.depthMemory = stored.content.colourMemory = nullptr;
}

void SpooledCamera::writeAll(const void* bytes, size_t count) {
    for (size_t done = 0; done < count;) {
        const ssize_t n =
            ::pwrite(descriptor_, static_cast<const char*>(bytes) + done, count - done, written_);
        if (n < 0 && errno != EINTR) {
            fail("cannot be written");
        }
        const size_t moved = n > 0 ? static_cast<size_t>(n) : 0;
        done += moved;
        written_ += static_cast<int64_t>(moved);
    }
}

void SpooledCamera::readAll(void* bytes, size_t count) {
    for (size_t done = 0; done < count;) {
        const ssize_t n = ::pread(descriptor_, static_cast<char*>(bytes) + done, count - done, read_);
        if (n == 0 || (n < 0 && errno != EINTR)) {
            fail("cannot be read");
        }
        const size_t moved = n > 0 ? static_cast<size_t>(n) : 0;
        done += moved;
        read_ += static_cast<int64_t>(moved);
    }
}

std::optional<Frame> SpooledCamera::next() {
    if (next_ == count_) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_->acquireFor(description());
    const bool still = stored_.size() < count_;
    const StoredFrame& stored = stored_[still ? 0 : next_];
    Frame::Content content = stored.content;
    if (still) {
        read_ = 0;
        content.index += static_cast<uint32_t>(next_);
        content.sourceNumber += next_;
    }
    ++next_;
    content.depth = slot->depth().first(info_.depth.pixels());
    const std::span<std::byte> colours = slot->colourBytes().first(stored.colourBytes);
    content.setColourBytes(colours);
    Frame frame = slot->lend(content);
    readAll(slot->depth().data(), content.depth.size_bytes());
    readAll(colours.data(), colours.size());
    return frame;
}

std::string spoolNotice(uint64_t done, uint64_t all, double seconds) {
    if (seconds < 1.0 || done == 0 || done >= all) {
        return "";
    }
    const double whole = seconds * static_cast<double>(all) / static_cast<double>(done);
    return "the run waits until the simulated camera has rendered its " + std::to_string(all) +
           " frames, about " + std::to_string(static_cast<unsigned>(std::ceil(whole))) +
           " s; camera.source.frames sets how many";
}

} // namespace fathom
