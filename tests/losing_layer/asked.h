// SPDX-License-Identifier: Apache-2.0
// What the layer is asked to do, by the environment and a file; and the surfaces that it has lost. The
// layer's mutex is held in every call.
#pragma once

#include <vulkan/vulkan.h>

namespace losing {

long number(const char* name);   // of the environment; 0 = not there
VkResult lossOf();               // what a lost device answers
bool askedFor(const char* call); // whether the file names this call; then it goes

// A surface that is lost takes no images until it is destroyed.
void hasImages(VkSurfaceKHR surface); // it is the newest that does
void loseSurface();                   // the newest
bool isLost(VkSurfaceKHR surface);
void forget(VkSurfaceKHR surface);

} // namespace losing
