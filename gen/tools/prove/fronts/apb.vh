    // A master within the rules; it may stay in SETUP, change its mind there, and leave at any time.
    wire t_held = psel;
    wire t_on = psel & penable;
    wire [10:0] t_address = paddr[12:2];
    wire t_refused = paddr[1:0] != 0;
    wire t_write = pwrite;
    wire [31:0] t_word = pwdata;
    wire t_answer = pready;
    wire t_error = pslverr;
    wire [31:0] t_read = prdata;
    wire t_left = abandoned;
    wire t_stands = psel & p_held & (t_address == p_asked) & (t_refused == p_refused) & (pwrite == p_writes) & (pwdata == p_word);
    always @* begin
        if (penable) assume (t_stands && !(p_on && p_answer));
    end
