#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

/// Writes a file of tests/data: a line for each member, and for each element of a list of objects.
inline void write_data_file(const std::filesystem::path& path, const nlohmann::ordered_json& data) {
    using nlohmann::ordered_json;
    std::ofstream file(path);
    const char* before = "{\n  ";
    for (const auto& [name, value] : data.items()) {
        file << std::exchange(before, ",\n  ") << ordered_json(name) << ": ";
        if (!value.is_array() || value.empty() || value.front().is_number()) {
            file << value;
            continue;
        }
        const char* between = "[\n    ";
        for (const ordered_json& element : value) file << std::exchange(between, ",\n    ") << element;
        file << "\n  ]";
    }
    file << "\n}\n";
}
