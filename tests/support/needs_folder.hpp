#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

/// Of a test case that reads a folder outside the project: `* NeedsFolder{"VRUT_TEST_MODELS"}`. The
/// environment variable names the folder. If it is not set, the case is skipped. The case belongs to the
/// suite of that name, which CTest runs as a test of its own (FOLDERS of vrut_test()) and reports as skipped.
struct NeedsFolder {
    const char* variable;

    void fill(doctest::detail::TestCase& test) const {
        test.m_test_suite = variable;
        test.m_skip = std::getenv(variable) == nullptr;
    }
};

/// The folder that the environment variable names.
inline std::filesystem::path folder_of(const char* variable) { return std::getenv(variable); }
