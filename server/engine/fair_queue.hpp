#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <string>

#include "engine/mailbox.hpp"

namespace vrut::server::engine {

/// What the render thread has taken and not handled: each client's events in their order, and the clients in
/// turn, one event each. What is of no client has a turn, too.
class FairQueue {
public:
    /// Where a client leaves, what it wants and its messages here are dropped. That it joined is not: what
    /// follows who is there has to hear of both.
    void push(EngineEvent event);
    /// The next. Not where the queue is empty.
    EngineEvent pop();
    bool empty() const { return events_.empty(); }
    /// From any thread.
    std::size_t size() const { return size_; }

private:
    std::map<std::string, std::deque<EngineEvent>> events_;  ///< by client, none empty; "": of none
    std::atomic<std::size_t> size_{0};
    std::string last_;  ///< whose event was taken
};

}  // namespace vrut::server::engine
