#include "parameters/body_names.h"
#include "base/suggestion.h"
#include "parameters/id_or_name.h"
#include "parameters/parameter_file.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <limits>

namespace Nodus
{
  void add_bodies(dealii::ParameterHandler &prm,
                  const std::string        &key,
                  RegionParameters         &region,
                  const std::string        &documentation)
  {
    prm.declare_entry(key,
                      region.bodies.empty() ? "0" : joined(region.bodies, region.body_names),
                      dealii::Patterns::List(IdOrName(), 1, std::numeric_limits<unsigned int>::max(), ","),
                      documentation);
    prm.add_action(key,
                   [&region](const std::string &text)
                   {
                     region.bodies.clear();
                     region.body_names.clear();
                     const auto items = dealii::Utilities::split_string_list(text, ',');
                     for (const std::string &item : items)
                       if (!is_id(item))
                         region.body_names.push_back(item);
                       else if (items.size() > 1 || item != "0")
                         region.bodies.push_back(std::stoul(item));
                   });
  }

  void add_body(dealii::ParameterHandler &prm,
                const std::string        &key,
                unsigned int             &number,
                std::string              &name,
                const std::string        &documentation)
  {
    prm.declare_entry(key, name.empty() ? std::to_string(number) : name, IdOrName(), documentation);
    prm.add_action(key,
                   [&number, &name](const std::string &text)
                   {
                     name = is_id(text) ? "" : text;
                     if (is_id(text))
                       number = std::stoul(text);
                   });
  }

  unsigned int number_of_body(const std::string                 &name,
                              const std::vector<BodyParameters> &bodies,
                              const ParameterFile               &file,
                              const std::string                 &section,
                              const std::string                 &key)
  {
    const auto body =
        std::find_if(bodies.begin(), bodies.end(), [&name](const BodyParameters &b) { return b.name == name; });
    if (body != bodies.end())
      return body - bodies.begin() + 1;
    std::vector<std::string> names;
    std::string              list;
    for (const BodyParameters &b : bodies)
    {
      names.push_back(b.name);
      list += (list.empty() ? "" : ", ") + std::to_string(names.size()) + (b.name.empty() ? "" : " (" + b.name + ")");
    }
    const auto near = nearest(name, names);
    file.refuse(section,
                key,
                "names '" + name + "', which no body has as its Name; the bodies are " + list +
                    (near.empty() ? "" : did_you_mean(near)));
  }
} // namespace Nodus
