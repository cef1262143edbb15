#include "screwline/symbolic/symbol_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace screwline {

int SymbolTable::add(Symbol symbol) {
  while (find(symbol.name)) symbol.name += "_";
  symbols_.push_back(std::move(symbol));
  return size() - 1;
}

std::optional<int> SymbolTable::find(const std::string& name) const {
  for (int id = 0; id < size(); ++id) {
    if ((*this)[id].name == name) return id;
  }
  return std::nullopt;
}

std::vector<double> SymbolTable::valuesAt(const ConstVectorRef& q) const {
  std::vector<double> values;
  for (const Symbol& symbol : symbols_) values.push_back(symbol.value);
  for (Eigen::Index i = 0; i < q.size(); ++i) values[static_cast<std::size_t>(i)] = q[i];
  return values;
}

std::string latexOfName(const std::string& name) {
  static const std::array<const char*, 9> kGreek = {"theta", "alpha", "beta",  "gamma", "phi",
                                                    "psi",   "rho",   "sigma", "delta"};
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  const std::string stem = name.substr(0, digits);
  const std::string index = digits < name.size() ? "_{" + name.substr(digits) + "}" : "";
  if (std::find(kGreek.begin(), kGreek.end(), stem) != kGreek.end()) return "\\" + stem + index;
  if (stem.size() == 1 && std::isalpha(static_cast<unsigned char>(stem.front())) != 0) return stem + index;
  std::string escaped;
  for (char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) escaped += '\\';
    escaped += c;
  }
  return "\\mathrm{" + escaped + "}";
}

}  // namespace screwline
