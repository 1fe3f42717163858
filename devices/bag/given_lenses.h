// SPDX-License-Identifier: Apache-2.0
// Lenses that a file gives instead of the recording.
#pragma once

#include "devices/bag/image_stream.h"
#include "devices/recorded/source_options.h"

namespace fathom {

struct StreamChoice;

// The lenses in the file SourceOptions::intrinsics, if the options name one. Each call reads the file, and
// throws BadInput for a fault of it.
class GivenLenses {
public:
    explicit GivenLenses(const SourceOptions& options)
        : options_(options) {}
    // Whether the recording relates depth and colour: a file of one lens alone says nothing about it.
    bool keepsRelation() const;
    // Depth with the lens of the file, or with that of colour where it is aligned to colour and the lens of
    // the file is nearly that of colour. Colour must have a lens.
    ImageStream withLens(const ImageStream& depth, const ImageStream& colour) const;
    // Replaces the lenses of a choice, and what else the file states. Throws BadInput for images of another
    // size.
    void replaceIn(StreamChoice& choice) const;

private:
    const SourceOptions& options_;
};

} // namespace fathom
