// An option such as --out is not broken behind its hyphens.
for (const code of document.querySelectorAll("main :not(pre) > code")) {
    code.innerHTML = code.innerHTML.replace(/-+[A-Za-z][\w-]*/g, '<span class="option">$&</span>');
}
