#include "exposition.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <sstream>
#include <utility>

namespace vrut::test {

namespace {

using Labels = std::map<std::string, std::string>;

const std::regex kHead(R"(# (HELP|TYPE) ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+))");
const std::regex kSample(R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(?:\{(.*)\})? (\S+))re");
const std::regex kLabel(R"re(([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\]|\\["\\n])*)"(,|$))re");

std::string unescaped(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escaped = text[i] == '\\';
        if (escaped) ++i;
        result += escaped && text[i] == 'n' ? '\n' : text[i];
    }
    return result;
}

Labels labels_of(std::string text) {
    Labels labels;
    std::smatch match;
    while (!text.empty()) {
        REQUIRE_MESSAGE(std::regex_search(text, match, kLabel, std::regex_constants::match_continuous), text);
        CHECK_MESSAGE(labels.emplace(match[1], unescaped(match[2])).second, text);
        text = match.suffix();
    }
    return labels;
}

double number_of(const std::string& text) {
    if (text == "+Inf") return std::numeric_limits<double>::infinity();
    std::size_t end = 0;
    const double value = std::stod(text, &end);
    CHECK_MESSAGE(end == text.size(), text);
    return value;
}

/// Rising bounds, never falling counts, the last of them that of all.
void check_histogram(const std::string& name, const Exposition::Family& family) {
    std::map<Labels, std::map<double, double>> buckets;
    std::map<Labels, double> counts;
    std::size_t sums = 0;
    for (Exposition::Sample sample : family.samples) {
        if (sample.name == name + "_bucket") {
            const double bound = number_of(sample.labels.at("le"));
            sample.labels.erase("le");
            auto& of = buckets[sample.labels];
            if (!of.empty()) CHECK(bound > of.rbegin()->first);
            if (!of.empty()) CHECK(sample.value >= of.rbegin()->second);
            of[bound] = sample.value;
        } else if (sample.name == name + "_count") {
            counts[sample.labels] = sample.value;
        } else {
            CHECK(sample.name == name + "_sum");
            ++sums;
        }
    }
    CHECK(counts.size() == buckets.size());
    CHECK(counts.size() == sums);
    for (const auto& [labels, of] : buckets) {
        CHECK(std::isinf(of.rbegin()->first));
        CHECK(of.rbegin()->second == counts.at(labels));
    }
}

void check_family(const std::string& name, const Exposition::Family& family) {
    CAPTURE(name);
    CHECK_FALSE(family.samples.empty());
    CHECK(family.help.back() == '.');
    if (family.type == "histogram") return check_histogram(name, family);
    CHECK((family.type == "counter" || family.type == "gauge"));
    CHECK(name.ends_with("_total") == (family.type == "counter"));
    for (std::size_t i = 0; i < family.samples.size(); ++i) {
        CHECK(family.samples[i].name == name);
        CHECK(family.samples[i].value >= 0);
        for (std::size_t j = 0; j < i; ++j) CHECK(family.samples[i].labels != family.samples[j].labels);
    }
}

}  // namespace

Exposition::Exposition(const std::string& text) {
    REQUIRE(text.ends_with('\n'));
    std::istringstream stream(text);
    std::string newest;
    for (std::string line; std::getline(stream, line);) {
        CAPTURE(line);
        std::smatch match;
        if (std::regex_match(line, match, kHead) && match[1] == "HELP") {
            newest = match[2];
            CHECK(families.emplace(newest, Family{"", match[3], {}}).second);
        } else if (std::regex_match(line, match, kHead)) {
            CHECK(match[2] == newest);
            CHECK(std::exchange(families[newest].type, match[3].str()).empty());
        } else {
            REQUIRE(std::regex_match(line, match, kSample));
            REQUIRE(match[1].str().starts_with(newest));  // all of a family in one place
            families[newest].samples.push_back({match[1], labels_of(match[2]), number_of(match[3])});
        }
    }
    for (const auto& [name, family] : families) check_family(name, family);
}

double Exposition::value(const std::string& name, const Labels& labels) const {
    for (const auto& [family_name, family] : families)
        for (const Sample& sample : family.samples)
            if (sample.name == name && sample.labels == labels) return sample.value;
    FAIL("there is no " << name);
    return 0;
}

bool Exposition::has(const std::string& name) const {
    if (const auto family = families.find(name); family != families.end())
        return family->second.type != "histogram";
    for (const auto& [family_name, family] : families)
        for (const Sample& sample : family.samples)
            if (sample.name == name) return true;
    return false;
}

}  // namespace vrut::test
