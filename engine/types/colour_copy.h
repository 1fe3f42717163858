// SPDX-License-Identifier: Apache-2.0
// Colours of a frame for readers on the host.
#pragma once

#include "engine/types/frame.h"

#include <vector>

namespace fathom {

// Converts the frame's colours to R8 G8 B8 A8; empty when it has none.
void readColours(const Frame::Content& content, std::vector<uint32_t>& rgba);
std::vector<uint32_t> coloursOf(const Frame::Content& content); // the same

// Copies a frame's colours before the frame is passed on and unpacks them afterwards, so that unpacking does
// not delay the frame.
class ColourCopy {
public:
    void take(const Frame::Content& content);
    // Like readColours(), for the colours taken last. May keep the memory of `rgba` for the next copy.
    void giveTo(std::vector<uint32_t>& rgba);

private:
    std::vector<uint32_t> words_; // or, if the camera does not send R8 G8 B8 A8:
    std::vector<std::byte> bytes_;
    RawColour raw_;
};

} // namespace fathom
