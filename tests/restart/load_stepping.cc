// Time control by itself: which increments follow from failures and successes.

#include "run/load_stepping.h"

#include <iostream>
#include <sstream>
#include <string>

using namespace Nodus;

namespace
{
  constexpr unsigned int easy = 5, hard = 11;

  LoadSteppingParameters parameters(const std::vector<double> &ends, const std::vector<unsigned int> &increments)
  {
    LoadSteppingParameters p;
    p.interval_ends = ends;
    p.increments    = increments;
    return p;
  }

  /// @p script: 'e' easy, 'h' hard (converged after many iterations), 'g' converged after a fallback, 'f' failure; the
  /// last letter is repeated. Prints the times of the converged increments.
  LoadStepping follow(const std::string &what, LoadStepping path, const std::string &script)
  {
    std::cout << what << ":";
    for (unsigned int i = 0; !path.finished(); ++i)
    {
      const char letter = script[std::min<std::size_t>(i, script.size() - 1)];
      if (letter == '.')
        break;
      if (letter != 'f')
      {
        std::cout << ' ' << path.target();
        path.accept(letter == 'h' ? hard : easy, letter != 'g');
      }
      else if (!path.cut_back())
      {
        std::cout << " given up in increment " << path.increment() << " from " << path.time() << " to "
                  << path.target();
        break;
      }
    }
    std::cout << std::endl;
    return path;
  }

  /// Under arc length: 'e', 'h' as above, the node that moves most by 0.2 and time by 0.1 in each increment; '0' where
  /// nothing moves, 'f' failure, 'b' beyond the end of the interval, '.' the last one that it may have.
  LoadStepping follow_arc(const std::string &what, LoadStepping path, const std::string &script)
  {
    std::cout << what << ":";
    for (const char letter : script)
    {
      const Increment increment = path.at_hand();
      if (letter == '.')
        std::cout << (path.exhausted() ? " no more" : " NOT EXHAUSTED");
      else if (letter == 'b')
        path.close_interval();
      else if (letter == 'f')
        std::cout << (path.cut_back() ? "" : " given up");
      else
      {
        std::cout << (increment.finds_time() ? " by " : " to ")
                  << (increment.finds_time() ? increment.arc : increment.end);
        path.accept(letter == 'h' ? hard : easy,
                    true,
                    {increment.finds_time() ? increment.begin + 0.1 : increment.end, letter == '0' ? 0. : 0.2});
      }
    }
    std::cout << (path.finished() ? ", finished" : "") << std::endl;
    return path;
  }
} // namespace

int main()
{
  const auto plain = parameters({1., 3.}, {4, 2});
  follow("as asked", LoadStepping(plain), "e");
  follow("hard, but as asked", LoadStepping(plain), "h");
  follow("one failure, then easy: back at the times asked for", LoadStepping(plain), "effe");
  follow("small increments stay while it is hard", LoadStepping(plain), "efh");
  follow("and after a fallback", LoadStepping(plain), "efg");
  follow("the next interval begins as asked", LoadStepping(plain), "eeefhe");
  follow("1/64 of the increment is the end", LoadStepping(plain), "ef");

  auto p              = plain;
  p.minimum_increment = 0.1;
  follow("minimum 0.1", LoadStepping(p), "ef");
  p.minimum_increment = 0.;
  p.cut_back          = false;
  follow("no cut-back", LoadStepping(p), "ef");

  p                   = parameters({1., 3.}, {10, 2});
  p.maximum_increment = 0.4;
  follow("growth up to 0.4", LoadStepping(p), "e");
  follow("a failure of a large one", LoadStepping(p), "eefe");
  follow("a failure of one that the end had shortened", LoadStepping(p), "eeefe");

  // Three halvings or eight increments: the same numbers to the last bit.
  LoadStepping halved(parameters({0.7, 1.9}, {3, 7})), fine(parameters({0.7, 1.9}, {24, 56}));
  bool         same = true;
  for (unsigned int interval = 0; interval < 2; ++interval)
  {
    for (unsigned int i = 0; i < 3; ++i)
      halved.cut_back();
    for (unsigned int n = 0; n < (interval == 0 ? 24 : 56); ++n)
    {
      same = same && halved.target() == fine.target() && halved.time() == fine.time();
      halved.accept(hard, true);
      fine.accept(hard, true);
    }
  }
  std::cout << "halved three times and divided by eight: " << (same && halved.finished() ? "equal" : "NOT EQUAL")
            << std::endl;

  // Arc length.
  auto arc    = parameters({1., 3.}, {4, 2});
  arc.control = {LoadSteppingParameters::Control::arc_length};
  follow_arc("as long as the first increment", LoadStepping(arc), "eee");
  follow_arc("the first one is halved", LoadStepping(arc), "fefe");
  follow_arc("times are given until something moves", LoadStepping(arc), "0ee");
  follow_arc("one failure, then hard, then easy", LoadStepping(arc), "eefhehee");
  follow_arc("1/64 is the end", LoadStepping(arc), "effffffff");
  follow_arc("to the end of both intervals", LoadStepping(arc), "eebeebe");
  follow_arc("the end is not met at first", LoadStepping(arc), "eebfhbh");
  arc.maximum_increments = 3;
  follow_arc("three increments of an interval", LoadStepping(arc), "eee.");
  arc.arc_length              = 0.05;
  arc.control                 = {LoadSteppingParameters::Control::time, LoadSteppingParameters::Control::arc_length};
  const LoadStepping half_way = follow_arc("the second interval by 0.05", LoadStepping(arc), "eeeeeefe");
  arc.arc_length              = 0.01;
  LoadStepping shorter(arc);
  shorter.continue_from(half_way);
  follow_arc("  goes on by 0.01", shorter, "e.");

  // Restarts.
  const LoadStepping stopped = follow("stopped half-way", LoadStepping(plain), "efe.");
  LoadStepping       again(plain);
  again.continue_from(stopped);
  follow("  goes on", again, "e");
  LoadStepping finer(parameters({1., 3.}, {20, 2}));
  finer.continue_from(stopped);
  follow("  goes on with 20 increments", finer, "e");
  LoadStepping longer(parameters({1., 3., 4.}, {4, 2, 2}));
  longer.continue_from(follow("done", LoadStepping(plain), "e"));
  follow("  prolonged", longer, "e");
}
