// SPDX-License-Identifier: Apache-2.0
// What the font library, the Vulkan layers and the software driver keep until the process ends is not ours
// and no leak of a test.
#ifdef FATHOM_SANITIZED
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig\nleak:libVkLayer\nleak:libvulkan\nleak:libLLVM\n";
}
#endif
