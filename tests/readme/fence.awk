# Prints the fenced blocks of a Markdown file that stand right after the line in the variable "mark".
/^```/ {
    if (inside) inside = printing = 0
    else { inside = 1; printing = marked }
    marked = 0
    next
}
printing { print; next }
!inside { if ($0 == mark) marked = 1; else if ($0 != "") marked = 0 }
