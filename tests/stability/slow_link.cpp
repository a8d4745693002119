#include "slow_link.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <deque>
#include <string>

namespace vrut::stability {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr int kSegment = 1448;     // bytes, as on most links
constexpr int kTakenAhead = 4096;  // bytes that wait at the link's begin; the kernel doubles it

/// What the two ways of a link share.
struct Line {
    LinkQuality quality;
    server::base::Clock::time_point stalled_until{};
    bool closed = false;
};

struct Ends {
    explicit Ends(asio::io_context& context) : near(context), far(context) {}
    void close() {
        error_code ignored;
        near.close(ignored);
        far.close(ignored);
    }
    tcp::socket near, far;
};

/// One direction: what is read leaves piece after piece, at the link's rate, and arrives after its delay.
class Way : public std::enable_shared_from_this<Way> {
public:
    Way(std::shared_ptr<Ends> ends, tcp::socket& from, tcp::socket& to, std::shared_ptr<const Line> line)
        : ends_(std::move(ends)),
          from_(from),
          to_(to),
          line_(std::move(line)),
          leaves_(from.get_executor()),
          arrives_(from.get_executor()) {}

    void read() {
        // Not more than leaves in a moment, or what is sent bit by bit would arrive in lumps.
        constexpr double kMoment = 0.05;  // s
        const double most = std::clamp(kMoment * line_->quality.bytes_per_second, 64.0, double{kSegment});
        from_.async_read_some(asio::buffer(piece_.data(), static_cast<std::size_t>(most)),
                              [self = shared_from_this()](error_code error, std::size_t size) {
                                  if (error) return self->push("");
                                  self->free_at_ = std::max(server::base::Clock::now(), self->free_at_) +
                                                   self->takes(size);
                                  self->leave(size);
                              });
    }

private:
    server::base::Clock::duration takes(std::size_t bytes) const {
        return std::chrono::duration_cast<server::base::Clock::duration>(
            std::chrono::duration<double>(static_cast<double>(bytes) / line_->quality.bytes_per_second));
    }

    void leave(std::size_t size) {
        leaves_.expires_at(std::max(free_at_, line_->stalled_until));
        leaves_.async_wait([self = shared_from_this(), size](error_code stopped) {
            if (stopped || self->line_->closed) return;
            if (server::base::Clock::now() < self->line_->stalled_until) return self->leave(size);
            self->free_at_ = std::max(self->free_at_, self->line_->stalled_until);
            self->push(std::string(self->piece_.data(), size));
            self->read();
        });
    }

    /// An empty one ends the connection.
    void push(std::string piece) {
        on_its_way_.push_back({server::base::Clock::now() + line_->quality.delay, std::move(piece)});
        if (on_its_way_.size() == 1) arrive();
    }

    void arrive() {
        arrives_.expires_at(std::max(on_its_way_.front().due, line_->stalled_until));
        arrives_.async_wait([self = shared_from_this()](error_code stopped) {
            if (stopped || self->line_->closed) return;
            if (server::base::Clock::now() < self->line_->stalled_until) return self->arrive();
            if (self->on_its_way_.front().bytes.empty()) return self->ends_->close();
            asio::async_write(self->to_, asio::buffer(self->on_its_way_.front().bytes),
                              [self](error_code error, std::size_t) {
                                  if (error) return self->ends_->close();
                                  self->on_its_way_.pop_front();
                                  if (!self->on_its_way_.empty()) self->arrive();
                              });
        });
    }

    struct Piece {
        server::base::Clock::time_point due;
        std::string bytes;
    };
    std::shared_ptr<Ends> ends_;
    tcp::socket& from_;
    tcp::socket& to_;
    std::shared_ptr<const Line> line_;
    asio::steady_timer leaves_, arrives_;
    std::array<char, kSegment> piece_{};
    server::base::Clock::time_point free_at_{};  ///< when what was put on the link so far has left
    std::deque<Piece> on_its_way_;
};

/// So that little waits in this machine's buffers that would not on a link.
void take_little_ahead(tcp::socket& socket) {
    error_code ignored;
    socket.set_option(asio::socket_base::receive_buffer_size(kTakenAhead), ignored);
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_MAXSEG, &kSegment, sizeof kSegment);
}

}  // namespace

struct SlowLink::Impl : std::enable_shared_from_this<SlowLink::Impl> {
    Impl(asio::io_context& the_context, std::uint16_t port, const LinkQuality& quality)
        : context(the_context),
          server(asio::ip::address_v4::loopback(), port),
          acceptor(the_context, tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
          line(std::make_shared<Line>(Line{quality, {}, false})) {}

    void accept() {
        auto made = std::make_shared<Ends>(context);
        acceptor.async_accept(made->near, [self = shared_from_this(), made](error_code error) {
            if (error) return;
            self->join(made);
            self->accept();
        });
    }

    void join(const std::shared_ptr<Ends>& made) {
        std::erase_if(all, [](const std::weak_ptr<Ends>& each) { return each.expired(); });
        all.push_back(made);
        error_code failed;
        made->far.open(tcp::v4());
        for (tcp::socket* end : {&made->near, &made->far}) take_little_ahead(*end);
        made->far.connect(server, failed);
        if (failed) return made->close();
        for (tcp::socket* end : {&made->near, &made->far}) end->set_option(tcp::no_delay(true), failed);
        std::make_shared<Way>(made, made->near, made->far, line)->read();
        std::make_shared<Way>(made, made->far, made->near, line)->read();
    }

    asio::io_context& context;
    tcp::endpoint server;
    tcp::acceptor acceptor;
    std::shared_ptr<Line> line;
    std::vector<std::weak_ptr<Ends>> all;
};

SlowLink::SlowLink(asio::io_context& context, std::uint16_t server_port, const LinkQuality& quality)
    : impl_(std::make_shared<Impl>(context, server_port, quality)) {
    impl_->accept();
}

SlowLink::~SlowLink() {
    impl_->line->closed = true;
    error_code ignored;
    impl_->acceptor.close(ignored);
    for (const auto& each : impl_->all)
        if (const auto ends = each.lock()) ends->close();
}

std::uint16_t SlowLink::port() const { return impl_->acceptor.local_endpoint().port(); }
void SlowLink::stall_until(server::base::Clock::time_point end) { impl_->line->stalled_until = end; }

}  // namespace vrut::stability
