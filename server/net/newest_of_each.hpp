#pragma once

#include <algorithm>
#include <deque>
#include <string>
#include <utility>

#include "net/document_updates.hpp"

namespace vrut::server::net {

/// What waits to be sent about several: of each the newest, in the order in which they began to wait.
class NewestOfEach {
public:
    static constexpr std::size_t kMost = 256;

    /// Takes the place of what waits about the same. Where kMost wait, the one that has waited longest is
    /// dropped.
    void put(const std::string& about, Text text) {
        const auto before = std::ranges::find(waiting_, about, &Waiting::first);
        if (before != waiting_.end())
            before->second = std::move(text);
        else
            waiting_.emplace_back(about, std::move(text));
        if (waiting_.size() > kMost) waiting_.pop_front();
    }
    bool empty() const { return waiting_.empty(); }
    std::size_t size() const { return waiting_.size(); }
    /// The one that has waited longest. Not where none waits.
    Text take() {
        Text text = std::move(waiting_.front().second);
        waiting_.pop_front();
        return text;
    }

private:
    using Waiting = std::pair<std::string, Text>;
    std::deque<Waiting> waiting_;
};

}  // namespace vrut::server::net
