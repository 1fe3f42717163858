// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_links.h"

#include "engine/model/cover_cache.h"
#include "engine/types/blocked_signals.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printable.h"
#include "engine/types/printed.h"
#include "engine/types/processors.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <set>
#include <thread>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kMaxHeld =
    6'000'000; // mesh corners kept in memory before their spheres are computed (plus one more mesh)

// Logs how far a long run is. Any thread.
class CoverProgress {
public:
    CoverProgress(size_t all, const CoverCache& cache)
        : all_(all)
        , cache_(cache) {}

    // cached: the cover is in the cache.
    void add(bool cached) {
        const size_t kept = cached ? ++cached_ : cached_.load(), done = ++done_;
        const auto now = Clock::now().time_since_epoch().count();
        auto due = due_.load();
        if (now >= due && done < all_ && due_.compare_exchange_strong(due, now + kEvery)) {
            log::progress("{}", coverProgressText(done, all_, kept, cache_.folder()));
        }
    }

private:
    static constexpr Clock::rep kEvery = Clock::duration(std::chrono::seconds(5)).count();

    size_t all_;
    const CoverCache& cache_;
    std::atomic<size_t> done_{0}, cached_{0};
    std::atomic<Clock::rep> due_{Clock::now().time_since_epoch().count() + kEvery};
};

struct LinkCover {
    const LinkGeometry* of = nullptr;
    LinkShape read;
    ShapeSpheres made;
    std::filesystem::path file; // of a mesh
    std::string note;           // on that file
    bool otherCapitals = false; // of the file than of the mesh's name
    std::string key;            // of the cache; empty = not cached
    bool found = false;         // in the cache
    std::exception_ptr refused;

    template <class Work>
    void attempt(const std::filesystem::path& urdf, const Work& work) {
        try {
            work();
        } catch (const ShapeRefused& e) {
            refused =
                std::make_exception_ptr(BadInput(urdf.string(), "link " + of->link, e.value, e.allowed));
        } catch (const BadInput& e) { // names the mesh
            refused = std::make_exception_ptr(
                BadInput(urdf.string() + ": link " + printable(of->link) + ": " + e.what()));
        } catch (...) {
            refused = std::current_exception();
        }
    }
};

// Everything besides the file's content that the cover of a mesh depends on.
std::string optionsText(const urdf::Mesh& mesh, const ShapeSource& source, uint32_t leaves) {
    return printed("%.17g %.17g %.17g %u %d", mesh.scale.x, mesh.scale.y, mesh.scale.z, leaves,
                   source.keepStray ? 1 : 0);
}

// Notes name the mesh file, whose name is no part of the content: the cache stores kFile instead.
constexpr const char* kFile = "\x01";

// from: not empty.
ShapeSpheres renamed(ShapeSpheres made, const std::string& from, const std::string& to) {
    for (std::string& note : made.notes) {
        for (size_t at = note.find(from); at != std::string::npos; at = note.find(from, at + to.size())) {
            note.replace(at, from.size(), to);
        }
    }
    return made;
}

// Takes a mesh's cover from the cache.
void look(LinkCover& one, const CoverCache& cache, const ShapeSource& source, uint32_t leaves) {
    MeshPlace place = meshFileOf(*one.of->shape, source);
    one.file = std::move(place.file);
    one.note = std::move(place.note);
    one.otherCapitals = place.otherCapitals;
    if (one.file.empty()) {
        return;
    }
    const auto& mesh = dynamic_cast<const urdf::Mesh&>(*one.of->shape);
    one.key = cache.keyOf(one.file, optionsText(mesh, source, leaves));
    if (auto cached = cache.find(one.key)) {
        one.made = renamed(std::move(*cached), kFile, one.file.string());
        one.made.outside = outsideOf(one.file, source);
        one.found = true;
    }
}

// Reads shapes until the memory bound is reached or one is rejected.
std::vector<LinkCover> readSome(std::span<const LinkGeometry> shapes, const ShapeSource& source,
                                const CoverCache& cache, uint32_t leaves) {
    std::vector<LinkCover> some;
    size_t points = 0;
    for (size_t i = 0; i < shapes.size() && points < kMaxHeld; ++i) {
        LinkCover& one = some.emplace_back();
        one.of = &shapes[i];
        one.attempt(source.urdf, [&] {
            look(one, cache, source, leaves);
            if (!one.found) {
                one.read = readLinkShape(*one.of->shape, source);
            }
        });
        points += one.read.points();
        if (one.refused) {
            break;
        }
    }
    return some;
}

void cover(std::vector<LinkCover>& some, const ShapeSource& source, const CoverCache& cache, uint32_t leaves,
           CoverProgress& progress) {
    std::atomic<size_t> next{0};
    const auto work = [&] {
        for (size_t i = next++; i < some.size(); i = next++) {
            LinkCover& one = some[i];
            bool cached = one.found;
            if (!one.refused && !one.found) {
                one.attempt(source.urdf, [&] {
                    one.made = linkSpheres(std::move(one.read), leaves);
                    cached =
                        !one.key.empty() && cache.store(one.key, renamed(one.made, one.file.string(), kFile));
                });
            }
            progress.add(cached);
        }
    };
    std::vector<std::jthread> others(std::min<size_t>(usableProcessors(), some.size()) - 1);
    {
        const BlockedSignals ofThreads;
        std::generate(others.begin(), others.end(), [&] { return std::jthread(work); });
    }
    work();
}

// One note for all, on the first link: a robot made on Windows has many.
void noteCapitals(std::span<const LinkGeometry> shapes, const std::vector<std::filesystem::path>& recased,
                  std::vector<ShapeSpheres>& made) {
    const auto first = std::ranges::find_if(recased, [](const auto& file) { return !file.empty(); });
    if (first == recased.end()) {
        return;
    }
    const auto at = static_cast<size_t>(first - recased.begin());
    const std::set<std::filesystem::path> files(first, recased.end());
    made[at].notes.push_back(first->string() + " is taken for '" +
                             excerpt(dynamic_cast<const urdf::Mesh&>(*shapes[at].shape).filename) +
                             "', which differs in capitals; meshes taken so: " +
                             std::to_string(files.size() - files.count(std::filesystem::path())));
}

} // namespace

std::string coverProgressText(size_t done, size_t all, size_t cached, const std::filesystem::path& folder) {
    const std::string text =
        std::to_string(done) + " of " + std::to_string(all) + " shapes are covered with spheres";
    return cached == 0
               ? text
               : text + "; the next start finds " + std::to_string(cached) + " of them in " + folder.string();
}

std::vector<ShapeSpheres> spheresOf(std::span<const LinkGeometry> shapes, ShapeSource source,
                                    uint32_t leaves) {
    for (const LinkGeometry& shape : shapes) {
        if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(shape.shape.get())) {
            source.names.insert(mesh->filename);
        }
    }
    std::vector<ShapeSpheres> made;
    std::vector<std::filesystem::path> recased; // files whose capitals differ from the mesh's name
    const CoverCache cache;
    CoverProgress progress(shapes.size(), cache);
    while (made.size() < shapes.size()) {
        std::vector<LinkCover> some = readSome(shapes.subspan(made.size()), source, cache, leaves);
        cover(some, source, cache, leaves, progress);
        for (LinkCover& one : some) {
            if (one.refused) {
                std::rethrow_exception(one.refused);
            }
            if (!one.note.empty()) {
                one.made.notes.push_back(one.note);
            }
            made.push_back(std::move(one.made));
            recased.push_back(one.otherCapitals ? one.file.lexically_normal() : std::filesystem::path());
        }
    }
    noteCapitals(shapes, recased, made);
    return made;
}

} // namespace fathom
