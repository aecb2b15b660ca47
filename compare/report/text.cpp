#include "compare/report/text.h"

#include "common/system/error.h"

#include <cstdlib>
#include <iomanip>

namespace duet::compare {

void print_cells(std::ostream& out, const std::vector<int>& widths, const std::vector<std::string>& cells) {
    DUET_CHECK(cells.size() <= widths.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        out << (widths[i] < 0 ? std::left : std::right) << std::setw(std::abs(widths[i])) << cells[i];
    out << '\n';
}

} // namespace duet::compare
