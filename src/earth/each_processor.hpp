// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// `EXCAVPLAN_FOR_EACH_PROCESSOR` before a function over plain arrays: it is compiled for several
/// processors, the one at hand is chosen when the program starts. Not under sanitizers, which start
/// later. No lambda in such a function: it would be compiled for the oldest processor.

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EXCAVPLAN_FOR_EACH_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define EXCAVPLAN_FOR_EACH_PROCESSOR
#endif
