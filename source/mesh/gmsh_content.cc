#include "mesh/gmsh_content.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    using PhysicalIds = GmshContent::PhysicalIds;

    const std::string again = "; write it again with gmsh";
    /// The number 1 as machines of the other byte order write it.
    constexpr int swapped_one = 1 << 24;

    /// Reads one file; every failure carries its name. Numbers of binary sections stand as they are in memory, and what
    /// is between the sections is text there, too.
    class Reader
    {
    public:
      explicit Reader(const std::string &file)
          : file_(file)
      {
        std::ifstream in(file, std::ios::binary);
        if (!in)
          fail("cannot be opened; the path is relative to the folder of the .prm file");
        text_.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
        here_ = text_.data();
        end_  = here_ + text_.size();
      }

      GmshContent read()
      {
        std::string version;
        for (std::string_view section; !(section = word()).empty();)
        {
          // A file may hold sections that say nothing about the mesh (names, periodicity, fields): skip them whole.
          if (section == "$MeshFormat")
            version = read_format();
          else if (version.empty())
            break;
          else if (section == "$Entities")
            read_section(section, [this] { read_entities(); });
          else if (section == "$Nodes")
            read_section(section, [&] { version == "2.2" ? read_nodes_22() : read_nodes_41(); });
          else if (section == "$Elements")
            read_section(section, [&] { version == "2.2" ? read_elements_22() : read_elements_41(); });
          else if (section[0] == '$' && section.substr(0, 4) != "$End")
            skip_section(section);
        }
        if (version.empty())
          fail("is not a gmsh .msh file: it does not start with $MeshFormat");
        return std::move(content_);
      }

    private:
      [[noreturn]] void fail(const std::string &reason) const
      {
        refuse_gmsh(file_, reason);
      }

      static bool is_space(const char c)
      {
        return c == ' ' || (c >= '\t' && c <= '\r');
      }

      /// The next word, empty at the end of the file.
      std::string_view word()
      {
        while (here_ != end_ && is_space(*here_))
          ++here_;
        const char *const begin = here_;
        while (here_ != end_ && !is_space(*here_))
          ++here_;
        return std::string_view(begin, here_ - begin);
      }

      /// From here to behind the line that ends the section. In binary data anything may look like the end of another.
      void skip_section(const std::string_view section)
      {
        const std::string_view rest(here_, end_ - here_);
        const auto             last = rest.find("\n$End" + (binary_ ? std::string(section.substr(1)) : std::string()));
        here_                       = last == std::string_view::npos ? end_ : here_ + last + 1;
        word();
      }

      /// A binary section that does not end where its counts say is damaged.
      template <typename Function>
      void read_section(const std::string_view section, const Function &read)
      {
        const std::string end = "$End" + std::string(section.substr(1));
        end_line();
        read();
        if (binary_ && word() != end)
          fail("has a damaged section " + std::string(section) + ", which does not end where it should" + again);
      }

      /// Binary numbers begin behind the line break.
      void end_line()
      {
        if (!binary_)
          return;
        while (here_ != end_ && *here_ != '\n')
          ++here_;
        if (here_ != end_)
          ++here_;
      }

      /// The next number, which is a Binary in a binary section.
      template <typename Binary, typename Number = Binary>
      Number next()
      {
        if (!binary_)
          return parse<Number>();
        Binary value{};
        if (static_cast<std::size_t>(end_ - here_) < sizeof(value))
          fail("ends early" + again);
        std::memcpy(&value, here_, sizeof(value));
        here_ += sizeof(value);
        return value;
      }
      /// Tags of nodes and elements, in the two formats.
      long tag_22()
      {
        return next<int, long>();
      }
      long tag_41()
      {
        return next<std::size_t, long>();
      }

      template <typename Number>
      Number parse()
      {
        while (here_ != end_ && (is_space(*here_) || *here_ == '+'))
          ++here_;
        Number     value{};
        const auto result = std::from_chars(here_, end_, value);
        if (result.ec != std::errc() || (result.ptr != end_ && !is_space(*result.ptr)))
          fail("ends early or holds text where a number belongs" + again);
        here_ = result.ptr;
        return value;
      }

      /// How many numbers follow, each of which takes two characters at least, or four bytes.
      template <typename Binary>
      std::size_t count()
      {
        const auto n = next<Binary, std::size_t>();
        if (n > static_cast<std::size_t>(end_ - here_) / (binary_ ? 4 : 2))
          fail("announces " + std::to_string(n) + " entries and ends before them" + again);
        return n;
      }

      std::string read_format()
      {
        const std::string version(word());
        const bool        binary = parse<int>() != 0;
        if (version != "2.2" && version != "4.1")
          fail("has format " + version + ": save with Mesh.MshFileVersion=4.1 (or 2.2)");
        if (!binary)
          return version;
        if (const auto size = parse<std::size_t>(); size != sizeof(std::size_t))
          fail("is binary with numbers of " + std::to_string(size) + " bytes instead of " +
               std::to_string(sizeof(std::size_t)) + ": save with Mesh.Binary=0");
        binary_ = true;
        end_line();
        const int one = next<int>();
        if (one == swapped_one)
          fail("is binary with the order of bytes of another kind of machine: save with Mesh.Binary=0");
        if (one != 1)
          fail("is damaged behind $MeshFormat" + again);
        return version;
      }

      unsigned int group_of(PhysicalIds ids)
      {
        const auto [group, is_new] = group_.try_emplace(std::move(ids), content_.physical.size());
        if (is_new)
          content_.physical.push_back(group->first);
        return group->second;
      }

      /// The sign holds the orientation only.
      int physical_id()
      {
        const int id = next<int>();
        if (id == std::numeric_limits<int>::min())
          fail("has a damaged physical id" + again);
        return std::abs(id);
      }

      unsigned int read_physical_ids()
      {
        PhysicalIds ids(count<std::size_t>());
        for (int &id : ids)
          id = physical_id();
        return group_of(std::move(ids));
      }

      /// Which physical groups each curve, surface, ... is in (4.1 only).
      void read_entities()
      {
        std::array<std::size_t, 4> n;
        for (auto &i : n)
          i = next<std::size_t>();
        for (unsigned int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < n[d]; ++i)
          {
            const int tag = next<int>();
            for (unsigned int j = 0; j < (d == 0 ? 3 : 6); ++j)
              next<double>(); // position or bounding box
            entities_[{d, tag}] = read_physical_ids();
            if (d > 0)
              for (auto j = next<std::size_t>(); j > 0; --j)
                next<int>(); // the entities that bound it
          }
      }

      void read_vertex(const long tag)
      {
        Point p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = next<double>();
        if (!std::isfinite(p.square()))
          fail("has no finite position for node " + std::to_string(tag) + again);
        if (!index_.try_emplace(tag, content_.vertices.size()).second)
          fail("defines node " + std::to_string(tag) + " twice" + again);
        content_.vertices.push_back(p);
      }

      void read_nodes_22()
      {
        const auto n = parse<std::size_t>();
        end_line();
        for (std::size_t i = 0; i < n; ++i)
          read_vertex(tag_22());
      }

      void read_nodes_41()
      {
        const auto n_blocks = next<std::size_t>();
        for (unsigned int i = 0; i < 3; ++i)
          next<std::size_t>(); // number of nodes, smallest and largest tag
        for (std::size_t block = 0; block < n_blocks; ++block)
        {
          const auto dimension = next<int>();
          next<int>(); // entity
          const bool        parametric = next<int>() != 0;
          std::vector<long> tags(count<std::size_t>());
          for (long &tag : tags)
            tag = tag_41();
          for (const long tag : tags)
          {
            read_vertex(tag);
            for (int d = 0; parametric && d < dimension; ++d)
              next<double>();
          }
        }
      }

      void read_elements_22()
      {
        const auto n = parse<std::size_t>();
        end_line();
        for (std::size_t i = 0; i < n;)
        {
          // in a binary file several elements may share their type and number of tags
          if (!binary_)
            parse<long>(); // element number
          const auto type     = next<int>();
          const auto together = binary_ ? next<int>() : 1;
          const auto n_tags   = count<int>();
          if (together < 1 || static_cast<std::size_t>(together) > n - i)
            fail("is damaged among its elements" + again);
          for (int j = 0; j < together; ++j, ++i)
          {
            if (binary_)
              next<int>();   // element number
            PhysicalIds ids; // the first of the tags
            for (std::size_t tag = 0; tag < n_tags; ++tag)
              if (tag > 0)
                next<int>();
              else if (const int id = physical_id(); id != 0)
                ids.push_back(id);
            read_element<int>(type, group_of(std::move(ids)));
          }
        }
      }

      void read_elements_41()
      {
        const auto n_blocks = next<std::size_t>();
        for (unsigned int i = 0; i < 3; ++i)
          next<std::size_t>(); // number of elements, smallest and largest tag
        for (std::size_t block = 0; block < n_blocks; ++block)
        {
          const auto         dimension = next<int>();
          const auto         tag       = next<int>();
          const auto         type      = next<int>();
          const auto         entity    = entities_.find({dimension, tag});
          const unsigned int group     = entity != entities_.end() ? entity->second : group_of({});
          for (auto n = next<std::size_t>(); n > 0; --n)
          {
            tag_41(); // element number
            read_element<std::size_t>(type, group);
          }
        }
      }

      /// @tparam Tag: of its nodes in a binary file
      template <typename Tag>
      void read_element(const int type, const unsigned int group)
      {
        // gmsh's types 1 to 19 are the elements of first and second order
        static constexpr unsigned int n_nodes[20] = {0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
        if (type < 1 || type > 19)
          fail("holds elements of gmsh type " + std::to_string(type) +
               ", nodus reads those of first and second order only: save with Mesh.ElementOrder=2 or 1");

        std::array<unsigned int, 27> nodes;
        for (unsigned int i = 0; i < n_nodes[type]; ++i)
        {
          const auto tag   = next<Tag, long>();
          const auto index = index_.find(tag);
          if (index == index_.end())
            fail("uses node " + std::to_string(tag) + ", which it does not define" + again);
          nodes[i] = index->second;
        }
        const auto is = [type](const std::initializer_list<int> types)
        { return std::find(types.begin(), types.end(), type) != types.end(); };
        if (is({3, 10, 16}))
          content_.quadrilaterals.push_back({group, {{nodes[0], nodes[1], nodes[2], nodes[3]}}});
        else if (is({5, 12, 17}))
        {
          if (!content_.hexahedra.empty() && content_.n_nodes_per_hexahedron != n_nodes[type])
            fail("mixes hexahedra of " + std::to_string(content_.n_nodes_per_hexahedron) + " and of " +
                 std::to_string(n_nodes[type]) +
                 " nodes: save the whole mesh with one Mesh.ElementOrder and one Mesh.SecondOrderIncomplete");
          content_.n_nodes_per_hexahedron = n_nodes[type];
          content_.hexahedra.push_back({group, static_cast<unsigned int>(content_.nodes.size())});
          content_.nodes.insert(content_.nodes.end(), nodes.begin(), nodes.begin() + n_nodes[type]);
        }
        else if (is({4, 11}))
          content_.others.push_back({group, "tetrahedra"});
        else if (is({6, 13, 18}))
          content_.others.push_back({group, "prisms"});
        else if (is({7, 14, 19}))
          content_.others.push_back({group, "pyramids"});
      }

      std::string                                 file_, text_;
      const char                                 *here_ = nullptr, *end_ = nullptr;
      bool                                        binary_ = false;
      GmshContent                                 content_;
      std::unordered_map<long, unsigned int>      index_; ///< node tag -> index into vertices
      std::map<PhysicalIds, unsigned int>         group_;
      std::map<std::pair<int, int>, unsigned int> entities_; ///< group of each curve, surface, ...
    };
  } // namespace

  GmshContent read_gmsh(const std::string &file)
  {
    return Reader(file).read();
  }

  void refuse_gmsh(const std::string &file, const std::string &reason)
  {
    throw InputError("mesh file " + file + ": " + reason);
  }
} // namespace Nodus
