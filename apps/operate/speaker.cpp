// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/speaker.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <dlfcn.h>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

namespace fathom::operate {

namespace {

// ALSA would write a line for each part of its configuration that it does not find.
void dropAlsaLine(const char*, int, const char*, int, const char*, ...) {}

// The part of ALSA's interface that is used: alsa/pcm.h, soname libasound.so.2. Constants have its values.
class Alsa {
public:
    Alsa() {
        library_ = ::dlopen("libasound.so.2", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (library_ == nullptr) {
            throw Error("libasound.so.2 is not installed");
        }
        const auto load = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(library_, name));
            if (function == nullptr) {
                throw Error(std::string("libasound.so.2 has no ") + name);
            }
        };
        load(open, "snd_pcm_open");
        load(close, "snd_pcm_close");
        load(setParams, "snd_pcm_set_params");
        load(write, "snd_pcm_writei");
        load(recover, "snd_pcm_recover");
        load(wait, "snd_pcm_wait");
        load(words, "snd_strerror");
        void (*setHandler)(void (*)(const char*, int, const char*, int, const char*, ...)) = nullptr;
        load(setHandler, "snd_lib_error_set_handler");
        setHandler(dropAlsaLine);
    }

    static constexpr int kPlayback = 0, kNonBlocking = 1, kInterleaved = 3, kS16 = 2;
    int (*open)(void**, const char*, int, int) = nullptr;
    int (*close)(void*) = nullptr;
    int (*setParams)(void*, int, int, unsigned, unsigned, int, unsigned) = nullptr;
    long (*write)(void*, const void*, unsigned long) = nullptr;
    int (*recover)(void*, int, int) = nullptr;
    int (*wait)(void*, int) = nullptr;
    const char* (*words)(int) = nullptr;

private:
    void* library_ = nullptr;
};

void need(const Alsa& alsa, int result, const char* what) {
    if (result < 0) {
        throw Error(std::string(what) + ": " + alsa.words(result));
    }
}

// Plays one tone on the default device. Throws Error. ended: asked between short waits.
template <class Ended>
void playOn(const Alsa& alsa, Tone tone, Ended&& ended) {
    constexpr unsigned kLatency = 100'000; // [us]
    constexpr int kWait = 50;              // [ms]
    std::vector<int16_t> samples = samplesOf(tone);
    samples.resize(samples.size() + kToneRate * kLatency / 1'000'000); // silence, which closing may cut off
    void* pcm = nullptr;
    need(alsa, alsa.open(&pcm, "default", Alsa::kPlayback, Alsa::kNonBlocking), "no sound card");
    const auto closing = [&](void* handle) { alsa.close(handle); };
    const std::unique_ptr<void, decltype(closing)> owner(pcm, closing);
    need(alsa, alsa.setParams(pcm, Alsa::kS16, Alsa::kInterleaved, 1, kToneRate, 1, kLatency), "sound card");
    for (size_t at = 0; at < samples.size() && !ended();) {
        const long written = alsa.write(pcm, samples.data() + at, samples.size() - at);
        if (written >= 0) {
            at += static_cast<size_t>(written);
        } else if (written != -EAGAIN) {
            need(alsa, alsa.recover(pcm, static_cast<int>(written), 1), "sound card");
        }
        if (at < samples.size()) {
            alsa.wait(pcm, kWait);
        }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(kLatency)); // the rest is in the card
}

} // namespace

struct Speaker::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Tone> next;
    std::string problem; // of the last tone
    bool ended = false, done = false;
    std::thread thread;

    void run() {
        std::unique_lock lock(mutex);
        while (true) {
            changed.wait(lock, [this] { return ended || next; });
            if (ended) {
                break;
            }
            const Tone tone = *std::exchange(next, std::nullopt);
            lock.unlock();
            const std::string why = attempt(tone);
            lock.lock();
            if (!why.empty() && problem.empty()) {
                log::warn("tones are silent: {}", why);
            }
            problem = why;
        }
        done = true;
        changed.notify_all();
    }

    std::string attempt(Tone tone) {
        try {
            static const Alsa kAlsa;
            playOn(kAlsa, tone, [this] {
                const std::lock_guard lock(mutex);
                return ended;
            });
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }
};

Speaker::Speaker()
    : shared_(std::make_unique<Shared>()) {
    shared_->thread = std::thread([shared = shared_.get()] { shared->run(); });
}

Speaker::~Speaker() {
    std::unique_lock lock(shared_->mutex);
    shared_->ended = true;
    shared_->changed.notify_all();
    const bool done =
        shared_->changed.wait_for(lock, std::chrono::seconds(1), [this] { return shared_->done; });
    lock.unlock();
    if (done) {
        shared_->thread.join();
    } else { // a sound server that hangs must not keep the program
        shared_->thread.detach();
        (void)shared_.release();
    }
}

void Speaker::play(Tone tone) {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->next = tone;
    }
    shared_->changed.notify_all();
}

} // namespace fathom::operate
