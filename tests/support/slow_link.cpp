#include "slow_link.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <deque>
#include <string>
#include <vector>

namespace vrut::test_support {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

/// The link that all connections share.
struct Link {
    LinkSchedule up, down;
};

/// Little waits in the kernel's buffers, as on a link, where nothing does. Yet the window must hold several
/// segments, and segments are small: while a window is smaller than the next segment, the kernel sends by its
/// timers alone, and after TCP_USER_TIMEOUT of that ends the connection.
template <class Socket>
void shrink_buffers(Socket& socket) {
    constexpr int kBuffer = 16384, kSegment = 1448;  // bytes; the kernel doubles the buffer
    error_code ignored;
    socket.set_option(asio::socket_base::receive_buffer_size(kBuffer), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(kBuffer), ignored);
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_MAXSEG, &kSegment, sizeof kSegment);
}

class Connection;
using Owner = std::shared_ptr<Connection>;

/// One direction of a connection. Each handler holds the connection that the flow is part of.
class Flow {
public:
    Flow(tcp::socket& from, tcp::socket& to, LinkSchedule& schedule)
        : from_(from),
          to_(to),
          schedule_(schedule),
          leaves_(from.get_executor()),
          arrives_(from.get_executor()) {}

    void read(const Owner& owner);
    void cancel();

private:
    struct Piece {
        Clock::time_point due;
        std::string bytes;  ///< none: the end
    };

    void leave(const Owner& owner, Clock::time_point due);
    void push(const Owner& owner, Piece piece);
    void arrive(const Owner& owner);
    void write(const Owner& owner);
    void end(const Owner& owner);
    bool is_full() const { return bytes_on_their_way_ > schedule_.capacity_bytes(); }

    tcp::socket& from_;
    tcp::socket& to_;
    LinkSchedule& schedule_;
    asio::steady_timer leaves_, arrives_;
    std::array<char, 2048> piece_{};
    std::deque<Piece> on_their_way_;
    std::size_t bytes_on_their_way_ = 0;
    bool waits_for_room_ = false;
    bool was_reset_ = false;
};

class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(asio::io_context& context, std::shared_ptr<Link> link)
        : near(context), far(context), link_(std::move(link)) {}

    void connect(const tcp::endpoint& server) {
        error_code failed;
        far.open(tcp::v4(), failed);
        shrink_buffers(far);
        far.async_connect(server, [self = shared_from_this()](error_code error) {
            if (error) return self->reset();
            self->begin();
        });
    }

    /// Both ends see that the connection was reset.
    void reset() {
        is_open = false;
        error_code ignored;
        for (tcp::socket* end : {&near, &far}) {
            end->set_option(asio::socket_base::linger(true, 0), ignored);
            end->close(ignored);
        }
        up_.cancel();
        down_.cancel();
    }

    tcp::socket near, far;
    bool is_open = true;

private:
    void begin() {
        if (!is_open) return;
        error_code ignored;
        for (tcp::socket* end : {&near, &far}) end->set_option(tcp::no_delay(true), ignored);
        up_.read(shared_from_this());
        down_.read(shared_from_this());
    }

    std::shared_ptr<Link> link_;
    Flow up_{near, far, link_->up}, down_{far, near, link_->down};
};

void Flow::read(const Owner& owner) {
    const auto buffer = asio::buffer(piece_.data(), std::min(piece_.size(), schedule_.max_piece_bytes()));
    from_.async_read_some(buffer, [this, owner](error_code error, std::size_t size) {
        if (!owner->is_open) return;
        was_reset_ = error && error != asio::error::eof;
        const LinkSchedule::Passage passage = schedule_.send(size, Clock::now());
        push(owner, {passage.arrives, std::string(piece_.data(), size)});
        if (!error) leave(owner, passage.leaves);
    });
}

/// Reads on when the link is free again.
void Flow::leave(const Owner& owner, Clock::time_point due) {
    leaves_.expires_at(schedule_.time_of(due));
    leaves_.async_wait([this, owner, due](error_code) {
        if (!owner->is_open) return;
        if (Clock::now() < schedule_.time_of(due)) return leave(owner, due);
        waits_for_room_ = is_full();
        if (!waits_for_room_) read(owner);
    });
}

void Flow::push(const Owner& owner, Piece piece) {
    bytes_on_their_way_ += piece.bytes.size();
    on_their_way_.push_back(std::move(piece));
    if (on_their_way_.size() == 1) arrive(owner);
}

void Flow::arrive(const Owner& owner) {
    arrives_.expires_at(schedule_.time_of(on_their_way_.front().due));
    arrives_.async_wait([this, owner](error_code) {
        if (!owner->is_open) return;
        if (Clock::now() < schedule_.time_of(on_their_way_.front().due)) return arrive(owner);
        if (on_their_way_.front().bytes.empty()) return end(owner);
        write(owner);
    });
}

void Flow::write(const Owner& owner) {
    asio::async_write(to_, asio::buffer(on_their_way_.front().bytes),
                      [this, owner](error_code error, std::size_t size) {
                          if (!owner->is_open) return;
                          if (error) return owner->reset();
                          bytes_on_their_way_ -= size;
                          on_their_way_.pop_front();
                          if (!on_their_way_.empty()) arrive(owner);
                          if (waits_for_room_ && !is_full()) {
                              waits_for_room_ = false;
                              read(owner);
                          }
                      });
}

void Flow::end(const Owner& owner) {
    if (was_reset_) return owner->reset();
    error_code ignored;
    to_.shutdown(tcp::socket::shutdown_send, ignored);
}

void Flow::cancel() {
    leaves_.cancel();
    arrives_.cancel();
}

}  // namespace

struct SlowLink::Impl : std::enable_shared_from_this<SlowLink::Impl> {
    Impl(asio::io_context& the_context, std::uint16_t port, const LinkQuality& quality)
        : context(the_context),
          server(asio::ip::address_v4::loopback(), port),
          acceptor(the_context, tcp::v4()),
          link(std::make_shared<Link>(Link{LinkSchedule(quality), LinkSchedule(quality)})) {
        shrink_buffers(acceptor);  // what it accepts has its options
        acceptor.bind({asio::ip::address_v4::loopback(), 0});
        acceptor.listen();
    }

    void accept() {
        auto made = std::make_shared<Connection>(context, link);
        acceptor.async_accept(made->near, [self = shared_from_this(), made](error_code error) {
            if (error) return;
            std::erase_if(self->connections, [](const auto& each) { return each.expired(); });
            self->connections.push_back(made);
            made->connect(self->server);
            self->accept();
        });
    }

    void cut() {
        for (const auto& each : connections)
            if (const auto connection = each.lock()) connection->reset();
        connections.clear();
    }

    asio::io_context& context;
    tcp::endpoint server;
    tcp::acceptor acceptor;
    std::shared_ptr<Link> link;
    std::vector<std::weak_ptr<Connection>> connections;
};

SlowLink::SlowLink(asio::io_context& context, std::uint16_t server_port, const LinkQuality& quality)
    : impl_(std::make_shared<Impl>(context, server_port, quality)) {
    impl_->accept();
}

SlowLink::~SlowLink() {
    error_code ignored;
    impl_->acceptor.close(ignored);
    cut();
}

std::uint16_t SlowLink::port() const { return impl_->acceptor.local_endpoint().port(); }

void SlowLink::set_quality(const LinkQuality& quality) {
    impl_->link->up.change(quality);
    impl_->link->down.change(quality);
}

void SlowLink::stall_until(Clock::time_point end) {
    impl_->link->up.stall_until(end);
    impl_->link->down.stall_until(end);
}

void SlowLink::cut() { impl_->cut(); }

}  // namespace vrut::test_support
