// SPDX-License-Identifier: Apache-2.0
// The font library keeps a cache until the process ends; it is not ours and no leak of a test.
#ifdef FATHOM_SANITIZED
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig\n";
}
#endif
