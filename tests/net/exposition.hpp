#pragma once

#include <map>
#include <string>
#include <vector>

namespace vrut::test {

/// Prometheus' text format, version 0.0.4, read strictly: the test fails at what is not of it.
struct Exposition {
    struct Sample {
        std::string name;
        std::map<std::string, std::string> labels;
        double value = 0;
    };
    struct Family {
        std::string type, help;
        std::vector<Sample> samples;
    };
    std::map<std::string, Family> families;

    explicit Exposition(const std::string& text);
    /// Of the one sample with that name and labels; fails the test where it is not there.
    double value(const std::string& name, const std::map<std::string, std::string>& labels = {}) const;
    /// A family's name, or that of a histogram's samples.
    bool has(const std::string& name) const;
};

}  // namespace vrut::test
