#ifndef nodus_parameters_generators_h
#define nodus_parameters_generators_h

#include <set>
#include <string>
#include <vector>

// The functions of deal.II's GridGenerator that make hexahedra from numbers in a file: their arguments in words.

namespace Nodus
{
  namespace Generators
  {
    std::vector<std::string> names();

    /// "radius (a number > 0; usually 1) : half of the length along x (...)".
    std::string arguments(const std::string &name);

    /// Arguments that work.
    std::string example(const std::string &name);

    /// What is wrong with the name; empty when deal.II has it.
    std::string mistake_in_name(const std::string &name);

    /// What is wrong with number and kind of the arguments, which stand between ':'; empty when nothing is, or when
    /// the generator is one that names() does not have.
    std::string mistake_in_arguments(const std::string &name, const std::string &text);

    /// What deal.II's function is called with: in newer versions some have one argument more.
    std::string arguments_for_deal_ii(const std::string &name, const std::string &arguments);

    /// The ids that the generated mesh has; none where it cannot be made at once.
    std::set<unsigned int> boundary_ids(const std::string &name, const std::string &arguments);

    /// Number of cells that the generator makes, but for a factor of 30 at most; 1 where the arguments do not say.
    double n_cells(const std::string &name, const std::string &arguments);
  } // namespace Generators
} // namespace Nodus

#endif
