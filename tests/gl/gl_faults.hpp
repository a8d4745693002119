#pragma once

#include <cstddef>

/// What goes wrong in this program's OpenGL, and with its threads. Whoever links gl_faults.cpp calls them
/// through it: it does what is said here, and leaves the rest to the driver.
namespace vrut::gl_faults {

/// The driver resets itself after so many draw calls: what is drawn and read then changes nothing, and it
/// tells of the reset once, until another context is made.
void reset_after(int draws);
/// Draw calls so far.
int draw_calls();
/// The next contexts that are asked for cannot be made.
void refuse_contexts(int count);
/// What buffers and textures hold now, in bytes.
std::size_t memory_used();
/// Bytes copied from memory to buffers and textures so far.
std::size_t bytes_copied();
/// They hold no more than so much from now on.
void limit_memory(std::size_t bytes);
/// Buffers and textures are given no memory from now on, and OpenGL reports that error.
void fail_allocations(unsigned error);
/// The next draw does nothing, and OpenGL reports that error.
void fail_draw(unsigned error);
/// The GPU is far behind: from now on the result of no query is available to who does not wait for it.
void withhold_queries();
/// How often a query's result was asked for before it was available.
int query_stalls();
/// So many threads cannot be begun.
void refuse_threads(int count);
/// The end of all that.
void heal();

}  // namespace vrut::gl_faults
