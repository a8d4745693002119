#pragma once

#include <string>
#include <vector>

namespace vrut::io {

/// Notices of one kind: the first few, and how many more there were.
class Notices {
public:
    void add(std::string notice) {
        if (first_.size() < kMost)
            first_.push_back(std::move(notice));
        else
            ++more_;
    }
    void append_to(std::vector<std::string>& all) const {
        all.insert(all.end(), first_.begin(), first_.end());
        if (more_ > 0) all.push_back("… and " + std::to_string(more_) + " more notices of this kind");
    }

private:
    static constexpr std::size_t kMost = 20;
    std::vector<std::string> first_;
    std::size_t more_ = 0;
};

}  // namespace vrut::io
