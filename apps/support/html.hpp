#pragma once
// What the pages that commands write share.
#include <string>

namespace drumlin::apps {

/// The style sheet, to stand in a <style> element: tables of numbers, verdicts, figures with captions.
std::string page_style();

/// Text with & < > " made safe to stand in a page.
std::string escaped(const std::string& text);

}  // namespace drumlin::apps
