#pragma once

// To be included once in a program that gives assimp broken files.

#ifdef __clang__
#pragma clang diagnostic ignored "-Wreserved-identifier"  // the name is the sanitizer's
#endif
/// assimp 5.2 does not free all that it had made of a file which it refuses in the end.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }
