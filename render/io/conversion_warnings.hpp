#pragma once

#include <map>
#include <string>
#include <vector>

namespace vrut::io {

/// What a conversion loses: one notice for each kind of loss, with the number of times.
class ConversionWarnings {
public:
    void add(const std::string& what, std::size_t times = 1) {
        if (times > 0) count_[what] += times;
    }
    void append_to(std::vector<std::string>& notices, const std::string& file) const {
        for (const auto& [what, count] : count_)
            notices.push_back(file + ": " + what +
                              (count > 1 ? " (" + std::to_string(count) + " times)" : ""));
    }

private:
    std::map<std::string, std::size_t> count_;
};

}  // namespace vrut::io
