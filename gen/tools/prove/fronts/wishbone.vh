// one_answer: ACK and ERR never come together.
    // A master within the rules; it may leave at any time, with a cycle before the next transfer.
    wire t_held = cyc & stb;
    wire t_on = cyc & stb;
    wire [10:0] t_address = adr;
    wire t_refused = we & (sel != 15);
    wire t_write = we;
    wire [31:0] t_word = dat_write;
    wire t_answer = ack | err;
    wire t_error = err;
    wire [31:0] t_read = dat_read;
    wire t_left = abandoned;
    wire t_stands = (t_address == p_asked) & (t_refused == p_refused) & (we == p_writes) & (dat_write == p_word);
    always @* begin
        if (t_on && p_on && !p_answer) assume (t_stands);
        one_answer: assert (!(ack && err));
    end
