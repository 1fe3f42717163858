// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is protected, what guides, the tool and the haptic parameters: a scene file (man fathom-scene).
#pragma once

#include <fathom/export.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace fathom::v0 {

/// A scene, read and checked. Immutable; any thread. Ignored are its camera source, hand path, simulated hand
/// and arm driver, because you submit the frames, the hand and the measured arm. `hand.map` applies. Engine
/// and Lockstep read the files that it names.
class FATHOM_API Scene {
public:
    /// Reads a scene file. @throws BadInput naming file, field, value and the allowed values
    static Scene fromFile(const std::filesystem::path& file);
    /// The same from the text of a scene file. Relative paths start at the working directory. @throws
    /// BadInput
    static Scene fromText(const std::string& yaml);

    std::size_t fixtures() const noexcept; ///< number of fixtures, in the order of the scene file
    /// Name of a fixture, for example of Contact::fixture; "visible surface" for kNoFixture. @throws BadInput
    /// for another index beyond fixtures()
    const std::string& fixtureName(std::size_t fixture) const;

    struct FATHOM_LOCAL Data;
    const Data& data() const noexcept { return *data_; } ///< for the library itself

private:
    explicit Scene(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
};

} // namespace fathom::v0
