#include "rigid/stl_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace Nodus
{
  namespace
  {
    using Corners = std::vector<std::array<Point, 3>>;

    /// Of a binary file: a header, the number of triangles, then for each the normal, the corners and an attribute.
    constexpr std::size_t header_size = 80, head = header_size + 4, triangle_size = 50;

    [[noreturn]] void refuse(const std::string &file, const std::string &complaint)
    {
      throw InputError(file + ": " + complaint);
    }

    std::uint32_t integer(const char *const bytes)
    {
      std::uint32_t result = 0;
      for (unsigned int i = 4; i-- > 0;)
        result = (result << 8) | static_cast<unsigned char>(bytes[i]);
      return result;
    }

    float number(const char *const bytes)
    {
      const std::uint32_t bits = integer(bytes);
      float               result;
      std::memcpy(&result, &bits, sizeof result);
      return result;
    }

    Corners read_binary(const std::string &file, const std::string &content)
    {
      Corners result(integer(content.data() + header_size));
      for (std::size_t t = 0; t < result.size(); ++t)
        for (unsigned int v = 0; v < 3; ++v)
          for (unsigned int c = 0; c < dim; ++c)
          {
            result[t][v][c] = number(content.data() + head + t * triangle_size + 12 * (v + 1) + 4 * c);
            if (!std::isfinite(result[t][v][c]))
              refuse(file,
                     "a coordinate of triangle " + std::to_string(t + 1) +
                         " is not a finite number; export the file again, or delete the triangle and fill the hole");
          }
      return result;
    }

    /// The words of an ASCII file, of which only names of solids depend on the ends of lines.
    class Words
    {
    public:
      Words(const std::string &file, const std::string &content)
          : file_(file)
          , at_(content.data())
          , end_(content.data() + content.size())
      {
      }

      /// The next one, in small letters; empty at the end.
      std::string next()
      {
        const auto blank = [](const char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        for (; at_ != end_ && blank(*at_); ++at_)
          line_ += *at_ == '\n';
        std::string word;
        for (; at_ != end_ && !blank(*at_); ++at_)
          word += *at_ >= 'A' && *at_ <= 'Z' ? static_cast<char>(*at_ + 'a' - 'A') : *at_;
        return word;
      }
      void skip_line()
      {
        at_ = std::find(at_, end_, '\n');
      }
      void expect(const std::string &wanted)
      {
        if (const std::string word = next(); word != wanted)
          refuse_word(word, "'" + wanted + "'");
      }
      double coordinate()
      {
        std::string       word   = next();
        const std::size_t begin  = !word.empty() && word[0] == '+' ? 1 : 0;
        double            result = 0.;
        const auto [stop, error] = std::from_chars(word.data() + begin, word.data() + word.size(), result);
        if (word.size() == begin || error != std::errc() || stop != word.data() + word.size() || !std::isfinite(result))
          refuse_word(word, "a finite number");
        return result;
      }
      [[noreturn]] void refuse_word(const std::string &word, const std::string &wanted) const
      {
        if (word.empty())
          refuse(file_,
                 "ends in line " + std::to_string(line_) + " where " + wanted +
                     " is expected: it is cut off; export it again");
        refuse(file_,
               "line " + std::to_string(line_) + ": '" + word.substr(0, 40) + "' where " + wanted +
                   " is expected; correct it, or export the file again");
      }

    private:
      const std::string &file_;
      const char *at_, *const end_;
      unsigned int line_ = 1;
    };

    Corners read_ascii(const std::string &file, const std::string &content)
    {
      Words   words(file, content);
      Corners result;
      bool    inside = false; // of a solid
      for (std::string word = words.next(); inside || !word.empty(); word = words.next())
        if (!inside)
        {
          if (word != "solid")
            words.refuse_word(word, "'solid'");
          words.skip_line();
          inside = true;
        }
        else if (word == "endsolid")
        {
          words.skip_line();
          inside = false;
        }
        else if (word == "facet")
        {
          for (unsigned int i = 0; i < 4; ++i)
            words.next(); // "normal" and its components, which other programs leave 0 or nan
          words.expect("outer");
          words.expect("loop");
          result.emplace_back();
          for (Point &corner : result.back())
          {
            words.expect("vertex");
            for (unsigned int c = 0; c < dim; ++c)
              corner[c] = words.coordinate();
          }
          words.expect("endloop");
          words.expect("endfacet");
        }
        else
          words.refuse_word(word, "'facet' or 'endsolid'");
      return result;
    }
  } // namespace

  std::vector<std::array<Point, 3>> read_stl(const std::string &file)
  {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
      refuse(file, "cannot be read; check its permissions");
    const std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    Corners           result;
    // Some programs begin binary files with "solid", too.
    const std::size_t n = content.size() < head ? 0 : integer(content.data() + header_size);
    if (content.size() >= head && content.size() == head + n * triangle_size)
      result = read_binary(file, content);
    else if (const std::string begin = content.substr(0, 1000); begin.find('\0') == std::string::npos)
    {
      if (!begin.empty() && Words(file, begin).next() != "solid")
        refuse(file, "does not begin with 'solid' as an ASCII STL file does; give an STL file, ASCII or binary");
      result = read_ascii(file, content);
    }
    else
      refuse(file,
             "has " + std::to_string(content.size()) + " bytes" +
                 (content.size() < head ? std::string(", less than the head of a binary STL file")
                                        : ", but a binary STL file of " + std::to_string(n) + " triangles has " +
                                              std::to_string(head + n * triangle_size)) +
                 "; it is cut off or no STL file: export it again");
    if (result.empty())
      refuse(file, "has no triangle; export the surface again");
    return result;
  }
} // namespace Nodus
