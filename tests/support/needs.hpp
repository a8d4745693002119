#pragma once

#include <doctest/doctest.h>

#include <cstdio>

/// Of a test case that not every machine can run: `* Needs(is_there, "Landlock")`. Without it the case is
/// skipped, and a line says so.
struct Needs {
    Needs(bool there, const char* name) : is_there(there), what(name) {}

    bool is_there;
    const char* what;

    void fill(doctest::detail::TestCase& test) const {
        test.m_skip = !is_there;
        if (!is_there) std::printf("skipped - %s: there is no %s\n", test.m_name, what);
    }
};
