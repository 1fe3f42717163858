// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_links.h"

#include "engine/types/error.h"
#include "engine/types/processors.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kMostHeld =
    6'000'000; // mesh corners kept in memory before their spheres are computed (plus one more mesh)

struct LinkCover {
    const LinkGeometry* of = nullptr;
    LinkShape read;
    ShapeSpheres made;
    std::exception_ptr refused;

    template <class Work>
    void attempt(const std::filesystem::path& urdf, const Work& work) {
        try {
            work();
        } catch (const ShapeRefused& e) {
            refused =
                std::make_exception_ptr(BadInput(urdf.string(), "link " + of->link, e.value, e.allowed));
        } catch (...) {
            refused = std::current_exception();
        }
    }
};

// Reads shapes until the memory bound is reached or one is rejected.
std::vector<LinkCover> readSome(std::span<const LinkGeometry> shapes, const ShapeSource& source) {
    std::vector<LinkCover> some;
    size_t points = 0;
    for (size_t i = 0; i < shapes.size() && points < kMostHeld; ++i) {
        LinkCover& one = some.emplace_back();
        one.of = &shapes[i];
        one.attempt(source.urdf, [&] { one.read = readLinkShape(*one.of->shape, source); });
        points += one.read.points();
        if (one.refused) {
            break;
        }
    }
    return some;
}

void cover(std::vector<LinkCover>& some, const ShapeSource& source, uint32_t leaves) {
    std::atomic<size_t> next{0};
    const auto work = [&] {
        for (size_t i = next++; i < some.size(); i = next++) {
            LinkCover& one = some[i];
            if (!one.refused) {
                one.attempt(source.urdf, [&] { one.made = linkSpheres(std::move(one.read), leaves); });
            }
        }
    };
    std::vector<std::jthread> others(std::min<size_t>(usableProcessors(), some.size()) - 1);
    std::generate(others.begin(), others.end(), [&] { return std::jthread(work); });
    work();
}

} // namespace

std::vector<ShapeSpheres> spheresOf(std::span<const LinkGeometry> shapes, const ShapeSource& source,
                                    uint32_t leaves) {
    std::vector<ShapeSpheres> made;
    while (made.size() < shapes.size()) {
        std::vector<LinkCover> some =
            readSome(shapes.subspan(made.size()), source); // before there are threads
        cover(some, source, leaves);
        for (LinkCover& one : some) {
            if (one.refused) {
                std::rethrow_exception(one.refused);
            }
            made.push_back(std::move(one.made));
        }
    }
    return made;
}

} // namespace fathom
