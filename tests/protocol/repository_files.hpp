#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

/// Committed files that follow from the sources.
inline const std::string kProtocol = VRUT_TEST_DATA "/../../../protocol/";

inline std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Compares the file with `text`. Whoever asks for it has the file written.
inline void check_file(const std::string& path, const std::string& text) {
    if (std::getenv("VRUT_RENEW")) std::ofstream(path, std::ios::binary) << text;
    const bool same = text_of(path) == text;
    CHECK_MESSAGE(same, path << " is not what the sources give; VRUT_RENEW=1 test_protocol writes it anew");
}
