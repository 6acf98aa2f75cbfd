#include "parameters/named_ids.h"
#include "base/suggestion.h"
#include "parameters/body_names.h"
#include "parameters/generators.h"
#include "parameters/id_or_name.h"
#include "parameters/parameter_file.h"
#include "parameters/physical_names.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <limits>

namespace Nodus
{
  namespace
  {
    /// So many names of a file are listed where one is wrong.
    constexpr std::size_t most_listed = 30;

    template <typename Number>
    void add_once(const Number id, std::vector<Number> &ids)
    {
      if (std::find(ids.begin(), ids.end(), id) == ids.end())
        ids.push_back(id);
    }

    /// What the mesh files of the bodies call by which name.
    class Groups
    {
    public:
      using Names = std::map<unsigned int, std::string>; ///< by id
      enum class Kind
      {
        surface,
        volume
      };

      explicit Groups(const std::vector<BodyParameters> &bodies)
          : bodies_(bodies)
      {
      }

      /// Several groups may have one name. Of a body without a file none.
      std::vector<unsigned int> ids(const unsigned int body, const Kind kind, const std::string &name)
      {
        std::vector<unsigned int> result;
        for (const auto &[id, candidate] : names(body, kind))
          if (candidate == name)
            result.push_back(id);
        return result;
      }

      /// What is to be said of a name that none of the bodies has.
      std::string complaint(const std::vector<unsigned int> &which, const Kind kind, const std::string &name)
      {
        const bool               surface = kind == Kind::surface;
        std::vector<std::string> all;
        std::string              text;
        for (const unsigned int b : which)
        {
          for (const auto &[id, candidate] : names(b, kind))
            add_once(candidate, all);
          text += "; " + described(b, kind);
          if (!ids(b, surface ? Kind::volume : Kind::surface, name).empty())
            text += ", and '" + name + "' is a " + (surface ? "volume" : "surface") + " of it";
        }
        for (unsigned int b = 0; b < bodies_.size(); ++b)
          if (std::find(which.begin(), which.end(), b) == which.end() && !ids(b, kind, name).empty())
            text += "; body " + std::to_string(b + 1) + (bodies_[b].name.empty() ? "" : " (" + bodies_[b].name + ")") +
                    " has it";
        const auto near = nearest(name, all);
        return "names '" + name + "', which is no physical " + (surface ? "surface" : "volume") + " of " +
               (which.size() == 1 ? "body " + std::to_string(which[0] + 1) : "any body") + text +
               (near.empty() ? "" : did_you_mean(near));
      }

    private:
      const Names &names(const unsigned int body, const Kind kind)
      {
        const std::string &file = bodies_[body].mesh_file;
        if (file.empty())
          return none_;
        auto found = of_file_.find(file);
        if (found == of_file_.end())
          found = of_file_.emplace(file, read_physical_names(file)).first;
        return kind == Kind::surface ? found->second.surfaces : found->second.volumes;
      }

      /// "mesh file seal.msh has 1 (top), 2 (seal_outer)".
      std::string described(const unsigned int b, const Kind kind)
      {
        const BodyParameters &body   = bodies_[b];
        const std::string     groups = kind == Kind::surface ? "surfaces" : "volumes";
        std::string           list;
        if (body.mesh_file.empty())
        {
          for (const unsigned int id : Generators::boundary_ids(body.generator, body.generator_arguments))
            list += (list.empty() ? " with the ids " : ", ") + std::to_string(id);
          return "body " + std::to_string(b + 1) + " is generated" + list + ", and names belong to mesh files";
        }
        std::size_t n = 0;
        for (const auto &[id, name] : names(b, kind))
          if (++n <= most_listed)
            list += (n == 1 ? " has the physical " + groups + " " : ", ") + named_id(id, {{id, name}});
        if (n == 0)
          list = " has no names of physical " + groups + ": give ids, or name them in gmsh";
        return "mesh file " + body.mesh_file + list + (n > most_listed ? ", ..." : "");
      }

      const std::vector<BodyParameters>   &bodies_;
      std::map<std::string, PhysicalNames> of_file_;
      const Names                          none_;
    };

    /// A boundary condition or one side of a contact pair, "Slave " or "Master " or nothing before its keys.
    struct Side
    {
      RegionParameters    &region;
      const std::string    section, prefix;
      const ParameterFile &file;
    };

    /// Numbers for the names of bodies.
    void resolve_bodies(const Side &side, const std::vector<BodyParameters> &bodies)
    {
      for (const std::string &name : side.region.body_names)
        side.region.bodies.push_back(
            number_of_body(name, bodies, side.file, side.section, prefixed(side.prefix, "Body")));
      side.region.body_names.clear();
    }

    /// Whether @p item is "2:5" or "lid:inner": an id or a name of one body, which it then adds.
    bool take_id_of_body(const std::string                 &item,
                         const Side                        &side,
                         const std::vector<BodyParameters> &bodies,
                         Groups                            &groups)
    {
      const auto colon = item.find(':');
      if (colon == std::string::npos)
        return false;
      const std::string body = item.substr(0, colon), id = item.substr(colon + 1);
      for (unsigned int b = 0; b < bodies.size(); ++b)
        if (body == std::to_string(b + 1) || body == bodies[b].name)
        {
          if (!side.region.has_body(b + 1))
            side.file.refuse(side.section,
                             prefixed(side.prefix, "Boundary ids"),
                             "has '" + item + "', but body " + body + " is not in '" + prefixed(side.prefix, "Body") +
                                 "'; add it there, or remove the id");
          const auto ids = is_id(id) ? std::vector<unsigned int>{static_cast<unsigned int>(std::stoul(id))}
                                     : groups.ids(b, Groups::Kind::surface, id);
          for (const unsigned int i : ids)
            add_once(i, side.region.ids_of_body[b + 1]);
          return !ids.empty();
        }
      return false;
    }

    void resolve(const Side &side, const std::vector<BodyParameters> &all, Groups &groups)
    {
      RegionParameters         &region = side.region;
      std::vector<unsigned int> bodies;
      for (unsigned int b = 0; b < all.size(); ++b)
        if (region.has_body(b + 1))
          bodies.push_back(b);
      if (bodies.size() < region.bodies.size())
        return; // which is the mistake to speak of
      std::vector<std::string> names;
      for (const std::string &name : region.boundary_names)
      {
        bool found = false;
        for (const unsigned int b : bodies)
          for (const unsigned int id : groups.ids(b, Groups::Kind::surface, name))
          {
            add_once(id, region.bodies.size() == 1 ? region.boundary_ids : region.ids_of_body[b + 1]);
            found = true;
          }
        if (found)
          names.push_back(name);
        else if (!take_id_of_body(name, side, all, groups))
          side.file.refuse(side.section,
                           prefixed(side.prefix, "Boundary ids"),
                           groups.complaint(bodies, Groups::Kind::surface, name));
      }
      region.boundary_names = region.bodies.size() == 1 ? std::vector<std::string>() : names;
    }
  } // namespace

  void add_ids(dealii::ParameterHandler  &prm,
               const std::string         &key,
               std::vector<unsigned int> &ids,
               std::vector<std::string>  &names,
               const std::string         &documentation)
  {
    prm.declare_entry(key,
                      joined(ids, names),
                      dealii::Patterns::List(IdOrName(), 0, std::numeric_limits<unsigned int>::max(), ","),
                      documentation);
    prm.add_action(key,
                   [&ids, &names](const std::string &text)
                   {
                     ids.clear();
                     names.clear();
                     for (const std::string &item : dealii::Utilities::split_string_list(text, ','))
                       if (is_id(item))
                         ids.push_back(std::stoul(item));
                       else
                         names.push_back(item);
                   });
  }

  bool RegionParameters::has_body(const unsigned int number) const
  {
    return bodies.empty() || std::find(bodies.begin(), bodies.end(), number) != bodies.end();
  }

  bool RegionParameters::takes(const unsigned int of_body, const dealii::types::boundary_id id) const
  {
    const auto has = [id](const auto &ids) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
    if (!has_body(of_body))
      return false;
    if (!has_ids())
      return !where.empty();
    const auto own = ids_of_body.find(of_body);
    return has(boundary_ids) || (own != ids_of_body.end() && has(own->second));
  }

  std::string RegionParameters::ids_text() const
  {
    std::string text = joined(boundary_ids, boundary_names);
    for (const auto &[body, ids] : ids_of_body)
      for (const auto id : ids)
        if (boundary_names.empty() || bodies.size() > 1)
          text += (text.empty() ? "" : ", ") + std::to_string(body) + ':' + std::to_string(id);
    return text;
  }

  std::string RegionParameters::body_numbers() const
  {
    return bodies.empty() ? "0" : joined(bodies, {});
  }

  std::string RegionParameters::bodies_text() const
  {
    return bodies.empty() ? "any body" : (bodies.size() == 1 ? "body " : "bodies ") + body_numbers();
  }

  void resolve_names(Parameters &parameters, const ParameterFile &file)
  {
    auto &bodies = parameters.bodies;
    // the regions, with what messages say of them
    const auto for_each_side = [&](const auto &f)
    {
      for (unsigned int i = 0; i < parameters.boundary_conditions.size(); ++i)
        f(Side{parameters.boundary_conditions[i].region, "Boundary condition " + std::to_string(i + 1), "", file},
          true);
      for (unsigned int i = 0; i < parameters.contact_pairs.size(); ++i)
      {
        ContactPairParameters &pair    = parameters.contact_pairs[i];
        const std::string      section = "Contact pair " + std::to_string(i + 1);
        f(Side{pair.slave, section, "Slave ", file}, !pair.slave.bodies.empty());
        f(Side{pair.master, section, "Master ", file}, !pair.master.bodies.empty() && !pair.has_rigid_master());
      }
    };
    for_each_side([&](const Side &side, bool) { resolve_bodies(side, bodies); });
    const auto resolve_body = [&](auto &place, const std::string &section)
    {
      if (!place.body_name.empty())
        place.body = number_of_body(place.body_name, bodies, file, section, "Body");
      place.body_name.clear();
    };
    for (unsigned int i = 0; i < parameters.output_points.size(); ++i)
      resolve_body(parameters.output_points[i], "Output point " + std::to_string(i + 1));
    for (unsigned int i = 0; i < parameters.output_lines.size(); ++i)
      resolve_body(parameters.output_lines[i], "Output line " + std::to_string(i + 1));
    for (const BodyParameters &body : bodies)
    {
      std::error_code unknown;
      if (!body.mesh_file.empty() && !std::filesystem::is_regular_file(body.mesh_file, unknown))
        return; // which is the mistake to speak of
    }
    Groups groups(bodies);
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      if (bodies[b].mesh_file.empty())
        continue;
      for (const std::string &name : bodies[b].volume_names)
      {
        const auto ids = groups.ids(b, Groups::Kind::volume, name);
        if (ids.empty())
          file.refuse("Body " + std::to_string(b + 1), "Volume ids", groups.complaint({b}, Groups::Kind::volume, name));
        for (const unsigned int id : ids)
          add_once(id, bodies[b].volume_ids);
      }
      bodies[b].volume_names.clear();
    }
    for_each_side(
        [&](const Side &side, const bool has_faces)
        {
          if (has_faces)
            resolve(side, bodies, groups);
        });
  }
} // namespace Nodus
