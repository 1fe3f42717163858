// SPDX-License-Identifier: Apache-2.0
// FATHOM_CLONES before a function compiles it once per instruction set and picks at load time. Off under
// sanitizers (the resolver runs before their runtime is ready) and with compilers that lack it; the results
// have the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(FATHOM_SANITIZED)
#define FATHOM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FATHOM_CLONES
#endif
