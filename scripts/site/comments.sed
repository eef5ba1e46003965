# comments of include/shoal.h as comments of Doxygen: before a declaration, behind a member, the example as code
s|^/\* shoal.h: |/** @file shoal.h\n * |
s|^struct shoal; .*|struct shoal;|
/^ \*     struct shoal .run;/,/^ \*     shoal_close/ {
    s|^ \*     struct shoal .run;|@verbatim\n&|
    s|^ \*     shoal_close.*|&\n@endverbatim|
    s|^ \*     ||
    s|\n \*     |\n|
}
s|^/\* ---.*||
s|^/\* |/** |
s|\([;,0-9]\) */\* |\1 /**< |
