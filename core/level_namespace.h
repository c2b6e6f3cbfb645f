#pragma once

/// The inline namespace of types that depend on the instruction level that a file is compiled for
/// (core/instruction_level.h): vectors, what is made of them, and classes whose inline functions
/// count on their width. Names of functions that take them then differ from level to level, and the
/// linker finds no function of one level for the caller of another.
///
/// Headers that use it are not installed, and only files that are compiled once a level, and their
/// tests, include them: scripts/check_includes.py.
#if defined(__AVX512F__)
#define ASDIC_LEVEL level_v4
#elif defined(__AVX2__)
#define ASDIC_LEVEL level_v3
#else
#define ASDIC_LEVEL level_v2
#endif
