#include "output/status_file.h"
#include "base/complete_file.h"

#include <ctime>
#include <iomanip>
#include <sstream>
#include <unistd.h>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// As JSON has it.
    std::string quoted(const std::string &text)
    {
      std::ostringstream result;
      result << '"' << std::hex << std::setfill('0');
      for (const char c : text)
        if (c == '"' || c == '\\')
          result << '\\' << c;
        else if (static_cast<unsigned char>(c) < 0x20)
          result << "\\u" << std::setw(4) << static_cast<int>(c);
        else
          result << c;
      result << '"';
      return result.str();
    }

    std::string utc_now()
    {
      const std::time_t  now = std::time(nullptr);
      std::tm            parts{};
      std::ostringstream text;
      text << std::put_time(gmtime_r(&now, &parts), "%Y-%m-%dT%H:%M:%SZ");
      return text.str();
    }

    std::string host()
    {
      char name[256] = "";
      gethostname(name, sizeof name - 1);
      return name;
    }
  } // namespace

  StatusFile::StatusFile(std::string folder, const double end_time, const double done, const unsigned int n_ranks)
      : folder_(std::move(folder))
      , end_time_(end_time)
      , done_at_start_(done)
      , n_ranks_(n_ranks)
      , started_(utc_now())
      , start_(std::chrono::steady_clock::now())
      , time_(done * end_time)
      , done_(done)
  {
    write("running", "");
  }

  void
  StatusFile::add(const unsigned int increment, const double time, const double done, const IterationCounts &counts)
  {
    increment_ = increment;
    time_      = time;
    done_      = done;
    counts_    = counts;
    newton_ += counts.newton;
    write("running", "");
  }

  void StatusFile::end(const std::string &state, const std::string &message)
  {
    write(state, message);
  }

  void StatusFile::write(const std::string &state, const std::string &message) const
  {
    const double  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    CompleteFile  file(folder_, "status.json");
    std::ostream &out = file.stream();
    out << "{\n  \"state\": " << quoted(state) << ",\n  \"message\": " << quoted(message)
        << ",\n  \"increment\": " << increment_ << ",\n  \"time\": " << time_ << ",\n  \"end time\": " << end_time_
        << ",\n  \"part done\": " << done_ << ",\n  \"Newton iterations\": " << counts_.newton
        << ",\n  \"cut-backs\": " << counts_.cut_backs << ",\n  \"fallbacks\": " << counts_.fallbacks
        << ",\n  \"Newton iterations of all increments\": " << newton_ << ",\n  \"seconds\": " << seconds
        << ",\n  \"seconds left\": ";
    // at the pace so far; nothing is known before the first increment
    if (state == "running" && done_ > done_at_start_)
      out << seconds * (1. - done_) / (done_ - done_at_start_);
    else
      out << "null";
    out << ",\n  \"ranks\": " << n_ranks_ << ",\n  \"host\": " << quoted(host()) << ",\n  \"process\": " << getpid()
        << ",\n  \"started\": " << quoted(started_) << ",\n  \"updated\": " << quoted(utc_now()) << "\n}\n";
    file.finish();
  }
} // namespace Nodus
