// A team of processes that are threads of the test.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/team.h"

namespace exactff::validation {

class Mailbox {
 public:
  void put(jobs::Message message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  std::optional<jobs::Message> take() {
    const std::lock_guard lock(mutex_);
    if (messages_.empty()) return std::nullopt;
    jobs::Message first = std::move(messages_.front());
    messages_.pop_front();
    return first;
  }

 private:
  std::mutex mutex_;
  std::deque<jobs::Message> messages_;
};

class ThreadTeam : public jobs::Team {
 public:
  ThreadTeam(std::vector<Mailbox>& mail, int rank) : mail_(mail), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(mail_.size()); }
  int ranks_on_this_machine() const override { return size(); }
  std::string place() const override { return "here"; }
  void send(int rank, std::string text) override {
    mail_[static_cast<std::size_t>(rank)].put({rank_, std::move(text)});
  }
  std::optional<jobs::Message> receive() override { return mail_[static_cast<std::size_t>(rank_)].take(); }

 private:
  std::vector<Mailbox>& mail_;
  const int rank_;
};

}  // namespace exactff::validation
