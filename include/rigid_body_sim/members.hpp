#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// The bodies that an effect acts on, by ascending index, and what it knows of each.
template <class Data>
class Members {
 public:
  struct Member {
    Eigen::Index body;
    Data data;
  };

  Members() = default;
  explicit Members(std::vector<Member> members) : members_(std::move(members)) {}

  std::size_t size() const { return members_.size(); }
  bool empty() const { return members_.empty(); }
  auto begin() const { return members_.begin(); }
  auto end() const { return members_.end(); }
  void add(Eigen::Index body, Data data) { members_.push_back({body, std::move(data)}); }

  /// Those of `some`, whose places in the list become their new indices.
  Members restrictedTo(const std::vector<Eigen::Index>& some) const {
    Members restricted;
    for (std::size_t k = 0; k < some.size(); ++k) {
      const auto found = std::lower_bound(
          members_.begin(), members_.end(), some[k],
          [](const Member& member, Eigen::Index body) { return member.body < body; });
      if (found != members_.end() && found->body == some[k])
        restricted.add(static_cast<Eigen::Index>(k), found->data);
    }
    return restricted;
  }

 private:
  std::vector<Member> members_;
};

}  // namespace rigid_body_sim
