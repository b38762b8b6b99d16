// A team under MPI, by Boost.MPI. It is a separate module that the program loads only if mpirun started it: loading MPI
// takes milliseconds, and most runs do not need it.
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "jobs/team.h"

namespace exactff::jobs {
namespace {

namespace mpi = boost::mpi;

constexpr int kTag = 0;

class MpiTeam : public Team {
 public:
  // Only the thread that constructs the team uses MPI. Exceptions end in a dismissal, not in an abort.
  MpiTeam() : environment_(mpi::threading::funneled, false) {
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(world_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &ranks_here_);
    MPI_Comm_free(&here);
  }
  ~MpiTeam() override {
    for (Sent& sent : sent_) sent.request.wait();
  }
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  int rank() const override { return world_.rank(); }
  int size() const override { return world_.size(); }
  int ranks_on_this_machine() const override { return ranks_here_; }
  std::string place() const override { return mpi::environment::processor_name(); }

  void send(int rank, std::string text) override {
    forget_what_arrived();
    Sent& sent = sent_.emplace_back(Sent{std::move(text), {}});
    sent.request = world_.isend(rank, kTag, sent.text.data(), static_cast<int>(sent.text.size()));
  }

  std::optional<Message> receive() override {
    forget_what_arrived();
    const auto status = world_.iprobe(mpi::any_source, kTag);
    if (!status) return std::nullopt;
    Message message{status->source(), std::string(static_cast<std::size_t>(*status->count<char>()), '\0')};
    world_.recv(message.rank, kTag, message.text.data(), static_cast<int>(message.text.size()));
    return message;
  }

 private:
  // Memory that MPI reads until the message has been sent.
  struct Sent {
    std::string text;
    mpi::request request;
  };

  void forget_what_arrived() {
    while (!sent_.empty() && sent_.front().request.test()) sent_.pop_front();
  }

  mpi::environment environment_;
  mpi::communicator world_;
  std::list<Sent> sent_;
  int ranks_here_ = 1;
};

}  // namespace
}  // namespace exactff::jobs

extern "C" exactff::jobs::Team* exactff_join_mpi() { return std::make_unique<exactff::jobs::MpiTeam>().release(); }
