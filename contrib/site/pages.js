// Typesets the equations of a page; delimiters are those that arithmatex leaves.
document.addEventListener("DOMContentLoaded", function () {
  for (const place of document.querySelectorAll(".arithmatex")) {
    renderMathInElement(place, {
      delimiters: [
        { left: "\\(", right: "\\)", display: false },
        { left: "\\[", right: "\\]", display: true },
      ],
      throwOnError: false,
    });
  }
});
