// Connections that wait for their clients: so many at most, holding so many bytes at most.
#pragma once

#include <cstddef>
#include <functional>
#include <list>

namespace gnomon::lab {

/// Who has waited longest has to go when another comes and there is no room. An honest client is quick; so it is the slow who go.
class WaitingRoom {
 public:
  struct Guest {
    std::size_t bytes = 0;        ///< held in memory for it
    std::function<void()> close;  ///< ends it, at once; it does not call the room
  };
  using Place = std::list<Guest>::iterator;

  WaitingRoom(std::size_t most_guests, std::size_t most_bytes)
      : most_guests_(most_guests), most_bytes_(most_bytes) {}

  /// One guest alone may hold more than the bytes of all.
  Place enter(Guest guest) {
    while (!guests_.empty() && (guests_.size() >= most_guests_ || bytes_ + guest.bytes > most_bytes_))
      close_oldest();
    bytes_ += guest.bytes;
    return guests_.insert(guests_.end(), std::move(guest));
  }
  void leave(Place place) {
    bytes_ -= place->bytes;
    guests_.erase(place);
  }
  void close_oldest() {
    if (guests_.empty()) return;
    const std::function<void()> close = std::move(guests_.front().close);
    leave(guests_.begin());
    close();
  }

 private:
  std::size_t most_guests_, most_bytes_, bytes_ = 0;
  std::list<Guest> guests_;  ///< the oldest first
};

}  // namespace gnomon::lab
