// verdicts CASE.prm: for each "Section/Key=value" of the standard input one line with what the program says to this
// case with this value: "taken", or the error. One start for hundreds of values, which --validate would need one by
// one.
#include <nodus/parameters/parameters.h>

#include <algorithm>
#include <iostream>
#include <string>

int main(int argc, char *argv[])
{
  if (argc != 2)
    return 2;
  std::string assignment;
  while (std::getline(std::cin, assignment))
  {
    std::string verdict = "taken";
    try
    {
      Nodus::Parameters::read(argv[1], {assignment});
    }
    catch (const Nodus::InputError &error)
    {
      verdict = error.what();
      std::replace(verdict.begin(), verdict.end(), '\n', ' ');
    }
    std::cout << verdict << '\n';
  }
  return 0;
}
